"""Operator: give all selected meshes the parts of the active one."""

from collections.abc import Callable

import bpy

from ...tasks.match_options import MatchOptions
from ...tasks.refusals import Refusal
from ...tasks.shape_registration import Registration
from ..blender.known_values import present
from ..blender.typed_properties import BoolProperty, TypedProperties
from ..jobs import background
from ..mesh_data.selected_meshes import other_meshes
from ..messages.user_errors import can_use_active_mesh
from ..parts.analysis_request import AnalysisRequest
from .registration_operator import RegistrationHandles, RegistrationOperator

NOTHING_ELSE = "Select the meshes to register, and last the one that has the parts."


class EIGENPARTS_OT_register_selected(RegistrationOperator, AnalysisRequest, TypedProperties, bpy.types.Operator):
    """Give all selected meshes the parts of the active one: the same numbers, names and colors"""

    bl_idname = "eigenparts.register_selected"
    bl_label = "Register Selected"
    bl_options = {"UNDO"}

    mirrored: bool = BoolProperty(
        name="Mirrored",
        description="The meshes are mirror images, such as a left hand and a right one, or as a negative scale makes"
        " them",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_start_with_others(cls, context, NOTHING_ELSE)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Registration], RegistrationHandles]:
        targets = other_meshes(context)
        if not targets:
            raise Refusal(NOTHING_ELSE)
        return self.start(
            context, present(context.object), targets, MatchOptions(mirrored=self.mirrored), self.analysis_settings()
        )


def can_start_with_others(operator: type[bpy.types.Operator], context: bpy.types.Context, nothing_else: str) -> bool:
    """Return whether a job from the active mesh to others can start; if not, let the operator say why."""
    if not background.can_start_job(operator) or not can_use_active_mesh(operator, context):
        return False
    if not other_meshes(context):
        operator.poll_message_set(nothing_else)
    return bool(other_meshes(context))


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_register_selected,))
