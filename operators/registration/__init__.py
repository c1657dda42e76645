"""The same parts on several meshes. Imports parts and what it imports."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__,
    [
        *("register_selected", "flip_function", "next_alternative"),
        *("point_pair_list", "add_point_pair", "remove_point_pair", "clear_point_pairs"),
    ],
)
