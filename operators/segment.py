"""Operator: divide an analyzed mesh into parts at another level."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from . import results, state
from .properties import MODE_ITEMS
from .refusals import can_use_active_mesh, refusals_told
from .viewport import show_vertex_colours


class EIGENPARTS_OT_segment(bpy.types.Operator):
    """Divide the analyzed mesh into parts: by level, threshold or number, or at the default level"""

    bl_idname = "eigenparts.segment"
    bl_label = "Segment"
    bl_options = {"UNDO"}

    level: IntProperty(name="Level", description="How many features to keep", options={"SKIP_SAVE"})
    threshold: FloatProperty(
        name="Threshold",
        description="Least height of a feature, as a fraction of the field's range",
        options={"SKIP_SAVE"},
    )
    n_parts: IntProperty(name="Parts", description="How many parts, the body included", options={"SKIP_SAVE"})

    mode: EnumProperty(
        name="Mode",
        description="What becomes a part; if not given, as it is on the mesh",
        items=MODE_ITEMS,
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and state.is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        given = [name for name in ("level", "threshold", "n_parts") if self.properties.is_property_set(name)]
        with refusals_told(self):
            mode = self.mode.lower() if self.properties.is_property_set("mode") else None
            labels = results.segment_mesh(
                context.object.data, mode=mode, **{name: getattr(self, name) for name in given}
            )
            show_vertex_colours(context)
            for warning in labels.warnings:
                self.report({"WARNING"}, warning)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_segment,))
