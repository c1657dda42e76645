"""Sidebar: bones and curves for the parts of the active mesh."""

import bpy

from ..operators.blender.registered_settings import skeleton_settings
from .tab import EigenpartsPanel, analyzed_mesh, draw_missing_analysis, main_row


class EIGENPARTS_PT_skeleton(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Skeleton"
    bl_order = 50
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if context.object is not None and context.object.type == "ARMATURE":
            # What was just created is active.
            layout.operator("object.posemode_toggle", icon="POSE_HLT")
            return
        if analyzed_mesh(context) is None:
            draw_missing_analysis(layout, context)
            return
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = skeleton_settings(context)
        layout.prop(settings, "weights")
        layout.prop(settings, "bones_in_limbs")
        row = main_row(self, context)
        if row is not None:
            row.operator("eigenparts.create_armature", icon="ARMATURE_DATA")
        layout.operator("eigenparts.create_skeleton_curves", text="Curves", icon="CURVE_DATA")


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_skeleton,))
