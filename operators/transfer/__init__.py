"""Weights, shape keys, maps and other layers brought to other meshes. Imports registration and what it imports."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["transfer_options", "transfer", "add_transfer_preset"]
)
