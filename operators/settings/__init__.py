"""What the panel shows and the user prefers. Imports every other room."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["mesh_settings", "preferences", "add_analysis_preset", "copy_report"]
)
