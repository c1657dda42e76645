"""Operator: remove everything Eigenparts left on a mesh."""

import bpy

from ..blender.known_values import mesh_of
from ..blender.outcome import Outcome
from ..mesh_data import mesh_arrays
from ..mesh_data.viewport import restore_colour_types
from ..mesh_state.state import forget, is_analyzed, read
from ..messages.user_errors import can_use_active_mesh
from ..outputs import output_registry
from ..outputs.ownership import mend
from ..outputs.rollback import all_or_nothing


class EIGENPARTS_OT_clear(bpy.types.Operator):
    """Remove all that Eigenparts left on the active mesh: analysis, parts and what shows them; what is yours stays"""

    bl_idname = "eigenparts.clear"
    bl_label = "Clear"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        mesh = mesh_of(context.object)
        mend(mesh, output_registry.result_attributes(read(mesh).outputs))
        with all_or_nothing(mesh):
            output_registry.remove(mesh)
            mesh_arrays.remove_own_attributes(mesh, mesh_arrays.own_names(mesh))
            mesh.property_unset("eigenparts")
            forget(mesh)
        if not any(is_analyzed(other) for other in bpy.data.meshes):
            restore_colour_types(context)
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_clear,))
