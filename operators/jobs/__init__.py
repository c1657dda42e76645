"""Long work beside the window, handles of meshes, and recent results. Imports messages, mesh_data."""

import bpy

register, unregister = bpy.utils.register_submodule_factory(__package__, ["job_status", "cancel"])
