"""Operator: take back all pairs of points."""

import bpy

from ..blender.outcome import Outcome
from ..blender.registered_settings import point_pairs
from ..mesh_data.viewport import redraw_views


class EIGENPARTS_OT_clear_point_pairs(bpy.types.Operator):
    """Take back all pairs of points of the scene"""

    bl_idname = "eigenparts.clear_point_pairs"
    bl_label = "Remove All Points"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not len(point_pairs(context)):
            cls.poll_message_set("There are no points.")
        return bool(len(point_pairs(context)))

    def execute(self, context: bpy.types.Context) -> Outcome:
        point_pairs(context).clear()
        redraw_views(context)
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_clear_point_pairs,))
