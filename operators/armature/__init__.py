"""Bones and curves in the parts. Imports parts and what it imports."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["skeleton_options", "create_armature", "create_skeleton_curves"]
)
