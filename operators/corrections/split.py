"""Operator: make two parts of one, along the field."""

from dataclasses import replace

import bpy

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.typed_properties import BoolProperty, FloatProperty, IntProperty, TypedProperties
from ..mesh_data.mesh_arrays import read_own_integers
from ..mesh_state import corrected_analysis
from ..mesh_state.state import MeshState
from ..outputs import part_writer
from ..outputs.division import PART
from .both_sides import MIRROR, correct_both
from .correction_request import BODY_IS_WHAT_IS_LEFT, CorrectsParts, new_item, refuse_absent


class EIGENPARTS_OT_split_part(CorrectsParts, TypedProperties, bpy.types.Operator):
    """Divide a part across, where no feature does: what lies beyond the new border becomes a part"""

    bl_idname = "eigenparts.split_part"
    bl_label = "Split Part"

    part: int = IntProperty(
        name="Part", description="Number of the part that is divided; the active one if not given", min=0
    )
    position: float = FloatProperty(
        name="Position",
        description="Where the new border lies: 0 at the old one, 1 at the tip",
        default=0.5,
        min=0,
        max=1,
        subtype="FACTOR",
    )
    mirror: bool = BoolProperty(name="X-Mirror", description=MIRROR, options={"SKIP_SAVE"})

    def correct(self, state: MeshState) -> None:
        correct_both(state, self.part, self.mirror, lambda now, part: split_part(now, part, self.position))


def split_part(state: MeshState, part: int, position: float) -> int:
    """Divide a part across, and return the number of the new one."""
    if part == 0:
        raise Refusal(BODY_IS_WHAT_IS_LEFT)
    refuse_absent(state, part)
    if not 0 < position < 1:
        raise Refusal("The position of the new border is between 0, the old border, and 1, the tip.")
    items, new = state.corrections, corrected_analysis.free_part(state)
    item = new_item(state, compute.SPLIT, part, other=new)
    start = next((made.value for made in items if made.kind == compute.SPLIT and made.other == part), 0.0)
    peak = corrected_analysis.peak_within(state, item, read_own_integers(state.mesh, PART) == part)
    item = replace(item, value=start + position * (peak - start))
    part_writer.correct(state, (*items, item), changed=len(items))
    return new


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_split_part,))
