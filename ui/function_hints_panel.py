"""Sidebar: which eigenfunctions suit the active mesh, where one of them is chosen as the field."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ..operators.mesh_state.function_hints import MOST_SHOWN
from ..operators.mesh_state.state import read
from .tab import EigenpartsPanel


class EIGENPARTS_PT_function_hints(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Eigenfunctions That Suit"
    bl_parent_id = "EIGENPARTS_PT_analyze"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        is_asked = context.scene.eigenparts.field == "EIGENFUNCTION"
        obj = context.object
        return is_asked and obj is not None and obj.type == "MESH" and bool(read(obj.data).function_hints)

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        for number, n_held, n_protrusions in read(context.object.data).function_hints[:MOST_SHOWN]:
            text = translated("{number}: {held} of {all} protrusions").format(
                number=number, held=n_held, all=n_protrusions
            )
            choose = column.operator("wm.context_set_int", text=text, translate=False)
            choose.data_path, choose.value = "scene.eigenparts.eigenfunction", number


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_function_hints,))
