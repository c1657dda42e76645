"""Operator: make one part of two that touch."""

import bpy

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.registered_settings import mesh_settings
from ..blender.typed_properties import BoolProperty, IntProperty, TypedProperties
from ..mesh_state import corrected_analysis
from ..mesh_state.state import MeshState
from ..outputs import part_writer
from .both_sides import MIRROR, correct_both, twin_of
from .correction_request import CorrectsParts, new_item, refuse_absent


class EIGENPARTS_OT_merge_parts(CorrectsParts, TypedProperties, bpy.types.Operator):
    """Join a part to another one that it touches, at every level that has both"""

    bl_idname = "eigenparts.merge_parts"
    bl_label = "Merge Parts"

    part: int = IntProperty(name="Part", description="Number of the part that goes; the active one if not given", min=0)
    into: int = IntProperty(
        name="Into",
        description="Number of the part that it joins, 0 for the body; the one it grows out of if not given",
        min=0,
    )

    mirror: bool = BoolProperty(name="X-Mirror", description=MIRROR, options={"SKIP_SAVE"})

    def fill_in(self, state: MeshState) -> None:
        """Join the active part to the one it grows out of."""
        super().fill_in(state)
        if not self.properties.is_property_set("into"):
            self.into = whole_of(state.mesh, self.part)

    def correct(self, state: MeshState) -> None:
        # The body keeps its number, so it is the other one that goes.
        part, into = (self.into, self.part) if self.part == 0 else (self.part, self.into)
        other = twin_of(state, into)
        targets = {part: into, twin_of(state, part): into if other is None else other}
        # Twins that become one are one pair only.
        mirror = self.mirror and other != part
        correct_both(state, part, mirror, lambda now, one: merge_parts(now, one, targets[one]))


def merge_parts(state: MeshState, part: int, into: int) -> None:
    """Join a part to another one."""
    if part == into:
        raise Refusal("A part cannot be merged with itself; choose another one.")
    if part == 0:
        # The body keeps its number, so it is the other one that goes.
        part, into = into, part
    refuse_absent(state, part, into)
    items = state.corrections
    item = new_item(state, compute.MERGE, part, other=into)
    try:
        part_writer.correct(state, (*items, item), changed=len(items))
    except Refusal as refusal:
        if str(refusal) != corrected_analysis.NO_EFFECT:
            raise
        names = [state.parts.name_of(number) for number in (part, into)]
        raise Refusal(f"{names[0]} and {names[1]} do not touch, so they cannot be one part.") from None


def whole_of(mesh: bpy.types.Mesh, part: int) -> int:
    """Return the part that a part grows out of, as the list shows it."""
    path: dict[int, int] = {}
    for row in mesh_settings(mesh).rows:
        path[row.depth] = row.part
        if row.part == part:
            return path.get(row.depth - 1, 0)
    return 0


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_merge_parts,))
