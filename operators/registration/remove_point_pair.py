"""Operator: take back one pair of points."""

import bpy

from ...tasks.refusals import Refusal
from ..blender.outcome import Outcome
from ..blender.registered_settings import point_pairs
from ..blender.typed_properties import IntProperty, TypedProperties
from ..mesh_data.viewport import redraw_views
from ..messages.user_errors import refusals_told


class EIGENPARTS_OT_remove_point_pair(TypedProperties, bpy.types.Operator):
    """Take back a pair of points; the numbers of those behind it go down by one"""

    bl_idname = "eigenparts.remove_point_pair"
    bl_label = "Remove Points"
    bl_options = {"UNDO"}

    number: int = IntProperty(name="Number", description="Which pair, from 1", default=1, min=1)

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            if self.number > len(point_pairs(context)):
                raise Refusal(f"There is no pair of points with the number {self.number}.")
            point_pairs(context).remove(self.number - 1)
            redraw_views(context)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_remove_point_pair,))
