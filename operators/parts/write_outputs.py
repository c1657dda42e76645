"""Operator: choose what the parts of a mesh are written to."""

import bpy

from ..blender.known_values import mesh_of
from ..blender.outcome import Outcome
from ..blender.typed_properties import EnumProperty, FloatProperty, TypedProperties
from ..mesh_state.state import is_analyzed_for, read
from ..messages.user_errors import can_use_active_mesh, refusals_told
from ..outputs import output_registry, part_writer


class EIGENPARTS_OT_write_outputs(TypedProperties, bpy.types.Operator):
    """Choose what the parts are written to; outputs that are left out are taken back"""

    bl_idname = "eigenparts.write_outputs"
    bl_label = "Write Outputs"
    bl_options = {"REGISTER", "UNDO"}

    outputs: set[str] = EnumProperty(
        name="Outputs",
        description="What the parts are written to, beside the attribute of the faces; all of it follows the level",
        items=[
            (output.key, output.name, output.description, 2**i)
            for i, output in enumerate(output_registry.OUTPUTS.values())
        ],
        options={"ENUM_FLAG"},
        default=set(output_registry.DEFAULT),
    )
    softness: float = FloatProperty(
        name="Softness",
        description="Width over which vertex groups pass from one part to the next; 0 for hard borders",
        subtype="DISTANCE",
        min=0,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and is_analyzed_for(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        state = read(mesh_of(context.object))
        self.outputs = {output.key for output in output_registry.chosen(state.outputs)}
        self.softness = state.softness
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            part_writer.write_outputs(mesh_of(context.object), self.outputs, self.softness)
            return {"FINISHED"}
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_write_outputs,))
