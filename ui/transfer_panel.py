"""Sidebar: transfer what an artist made from the active mesh to the others that are selected."""

import bpy

from .tab import EigenpartsPanel


class EIGENPARTS_PT_transfer(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Transfer"
    bl_order = 40
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        options = context.scene.eigenparts_transfer
        layout.column(heading="").prop(options, "layers")
        if "GROUPS" in options.layers:
            layout.prop(options, "groups")
        if "GROUPS" in options.layers and options.groups == "NAMED":
            layout.prop(options, "group_names")
        for name in ("factor", "mask", "unsure", "selects_unsure", "mirrored", "use_modifiers"):
            layout.prop(options, name)
        layout.operator("eigenparts.transfer", icon="MOD_DATA_TRANSFER")


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_transfer,))
