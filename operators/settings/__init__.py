"""Settings of meshes and preferences of the user. Imports every other room."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["mesh_settings", "preferences", "add_analysis_preset", "copy_report"]
)
