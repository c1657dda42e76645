"""Sidebar: trace complexes, plot diagrams, and the switches of what is seen of borders and complexes."""

import bpy

from ..operators.mesh_state.palette import COMPLEX_COLOURS
from .overlay_switches import BORDERS, SHOW_THROUGH, SHOWN
from .tab import EigenpartsPanel
from .traced_objects import objects_of_roles


class EIGENPARTS_PT_topology(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Topology"
    bl_order = 60
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        switches = context.window_manager
        column = self.layout.column(heading="Show")
        column.prop(switches, BORDERS)
        traced = column.column()
        traced.active = any(objects_of_roles(context, COMPLEX_COLOURS))
        for name in SHOWN:
            traced.prop(switches, f"eigenparts_{name}")
        traced.prop(switches, SHOW_THROUGH)
        column = self.layout.column()
        column.operator("eigenparts.trace_complex", icon="OUTLINER_OB_CURVE")
        column.operator("eigenparts.plot_diagram", icon="IMAGE_DATA")


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_topology,))
