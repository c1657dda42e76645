"""Operator: give the inside of one part a level of its own."""

import bpy

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.typed_properties import BoolProperty, IntProperty, TypedProperties
from ..mesh_state.state import MeshState
from ..outputs import part_writer
from .correction_request import BODY_IS_WHAT_IS_LEFT, CorrectsParts, new_item, refuse_absent


class EIGENPARTS_OT_set_branch_level(CorrectsParts, TypedProperties, bpy.types.Operator):
    """Divide one part more or less finely than the rest: inside it, another level counts"""

    bl_idname = "eigenparts.set_branch_level"
    bl_label = "Set Level of Part"

    part: int = IntProperty(
        name="Part", description="Number of the part that is divided by itself; the active one if not given", min=0
    )
    level: int = IntProperty(name="Level", description="Level that counts inside the part")
    reset: bool = BoolProperty(name="Reset", description="Let the level of the mesh count again", options={"SKIP_SAVE"})

    def fill_in(self, state: MeshState) -> None:
        """Begin with the level that the mesh shows."""
        super().fill_in(state)
        if not self.properties.is_property_set("level"):
            self.level = state.level

    def correct(self, state: MeshState) -> None:
        set_branch_level(state, self.part, None if self.reset else self.level)


def set_branch_level(state: MeshState, part: int, level: int | None) -> None:
    """Give the inside of a part a level of its own, or take it away again if None."""
    if part == 0:
        raise Refusal(BODY_IS_WHAT_IS_LEFT)
    n_levels = state.summary.n_levels
    if level is not None and not 0 <= level < n_levels:
        raise Refusal(f"Level {level} does not exist; this shape has levels 0 to {n_levels - 1}.")
    others = tuple(item for item in state.corrections if (item.kind, item.part) != (compute.LEVEL, part))
    if level is None:
        part_writer.correct(state, others)
        return
    refuse_absent(state, part)
    item = new_item(state, compute.LEVEL, part, value=float(level))
    part_writer.correct(state, (*others, item), changed=len(others))


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_set_branch_level,))
