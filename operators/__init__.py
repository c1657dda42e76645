"""Everything a user can do, in one room for each purpose; each imports those that stand before it here.

blender, messages, mesh_data, mesh_state, outputs, jobs, parts, corrections, registration, transfer, armature,
topology, settings
"""

import bpy

register, unregister = bpy.utils.register_submodule_factory(
    __package__,
    ["outputs", "jobs", "parts", "corrections", "registration", "transfer", "armature", "topology", "settings"],
)
