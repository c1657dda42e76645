"""Sidebar: transfer what an artist made from the active mesh to the others that are selected."""

import bpy

from ..operators.blender.registered_settings import transfer_settings
from ..operators.mesh_data.selected_meshes import other_meshes
from .tab import EigenpartsPanel, draw_direction, main_row
from .transfer_presets import EIGENPARTS_PT_transfer_presets


class EIGENPARTS_PT_transfer(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Transfer"
    bl_order = 40
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        EIGENPARTS_PT_transfer_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        options = transfer_settings(context)
        draw_direction(layout, context)
        grid = layout.grid_flow(row_major=True, columns=2, even_columns=True, align=True)
        grid.prop(options, "layers")
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(options, "method")
        if "GROUPS" in options.layers:
            column.prop(options, "groups")
        if "GROUPS" in options.layers and options.groups == "NAMED":
            column.prop(options, "group_names")
        row = main_row(self, context)
        if row is not None:
            row.operator("eigenparts.transfer", icon="MOD_DATA_TRANSFER")


class EIGENPARTS_PT_transfer_options(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Options"
    bl_parent_id = "EIGENPARTS_PT_transfer"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        options, others = transfer_settings(context), other_meshes(context)
        layout.prop(options, "mirrored")
        layout.prop(options, "use_modifiers")
        layout.prop(options, "factor")
        if others:
            layout.prop_search(options, "mask", others[0], "vertex_groups")
        else:
            layout.prop(options, "mask")
        layout.prop(options, "unsure")
        layout.prop(options, "selects_unsure")


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_transfer, EIGENPARTS_PT_transfer_options))
