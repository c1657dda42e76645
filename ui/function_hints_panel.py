"""Sidebar: which eigenfunctions suit the active mesh, where one of them is chosen as the field."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ..operators.blender.known_values import present
from ..operators.blender.registered_settings import analysis_settings
from ..operators.mesh_state.function_hints import MOST_SHOWN
from ..operators.mesh_state.state import read
from .tab import EigenpartsPanel, active_mesh


class EIGENPARTS_PT_function_hints(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Eigenfunctions That Suit"
    bl_parent_id = "EIGENPARTS_PT_analyze"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        mesh = active_mesh(context)
        is_asked = analysis_settings(context).field == "EIGENFUNCTION"
        return is_asked and mesh is not None and bool(read(mesh).function_hints)

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        hints = read(present(active_mesh(context))).function_hints
        for number, n_held, n_protrusions in hints[:MOST_SHOWN]:
            text = translated("{number}: {held} of {all} protrusions").format(
                number=number, held=n_held, all=n_protrusions
            )
            choose = present(column.operator("wm.context_set_int", text=text, translate=False))
            choose.data_path, choose.value = "scene.eigenparts.eigenfunction", number


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_function_hints,))
