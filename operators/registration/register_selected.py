"""Operator: give all selected meshes the parts of the active one."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty

from ..jobs import background
from ..messages.user_errors import Refusal, can_use_active_mesh
from ..parts.fresh_analysis import FreshAnalysis
from .register_meshes import Registration, Wish
from .registering import SETTINGS, Registers, Tickets

NOTHING_ELSE = "Select the meshes to register, and last the one that has the parts."


class EIGENPARTS_OT_register_selected(Registers, FreshAnalysis, bpy.types.Operator):
    """Give all selected meshes the parts of the active one: the same numbers, names and colors"""

    bl_idname = "eigenparts.register_selected"
    bl_label = "Register Selected"
    bl_options = {"UNDO"}

    mirrored: BoolProperty(
        name="Mirrored",
        description="The meshes are mirror images, such as a left hand and a right one; not needed where only the"
        " scale of an object mirrors it",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_start_with_others(cls, context, NOTHING_ELSE)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Registration], Tickets]:
        targets = other_meshes(context)
        if not targets:
            raise Refusal(NOTHING_ELSE)
        settings = {name: getattr(self, name) for name in SETTINGS}
        return self.start(context, context.object, targets, Wish(mirrored=self.mirrored), settings)


def can_start_with_others(operator: type[bpy.types.Operator], context: bpy.types.Context, nothing_else: str) -> bool:
    """Return whether a job from the active mesh to others can start; if not, let the operator say why."""
    if not background.can_start_job(operator) or not can_use_active_mesh(operator, context):
        return False
    if not other_meshes(context):
        operator.poll_message_set(nothing_else)
    return bool(other_meshes(context))


def other_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return an object for each selected mesh other than the active one's."""
    objects = {obj.data: obj for obj in context.selected_objects if obj.type == "MESH"}
    return [obj for mesh, obj in objects.items() if mesh != context.object.data]


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_register_selected,))
