"""Corrections of parts by hand, and the cut along their borders. Imports parts and what it imports."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["branch_level", "merge", "split", "move_border", "paint", "remove", "remove_all", "cut"]
)
