"""From a mesh to its parts: analyze, segment, pick, separate, clear. Imports the rooms below it."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__, ["analysis_options", "analyze", "segment", "select", "pick", "write_outputs", "clear", "separate"]
)
