"""Operator: move the border of a part along the field."""

from dataclasses import replace

import bpy

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.typed_properties import BoolProperty, FloatProperty, IntProperty, TypedProperties
from ..mesh_state import corrected_analysis
from ..mesh_state.state import MeshState
from ..outputs import part_writer
from .both_sides import MIRROR, correct_both
from .correction_request import BODY_IS_WHAT_IS_LEFT, CorrectsParts, new_item, refuse_absent


class EIGENPARTS_OT_move_border(CorrectsParts, TypedProperties, bpy.types.Operator):
    """Move the border of a part along the field, outward or inward"""

    bl_idname = "eigenparts.move_border"
    bl_label = "Move Border"

    part: int = IntProperty(
        name="Part", description="Number of the part whose border is moved; the active one if not given", min=0
    )
    offset: float = FloatProperty(
        name="Offset",
        description="How far the border is moved from where it was found, as a fraction of the field's range; the part"
        " grows with it",
        min=-1,
        max=1,
        precision=3,
        step=0.5,
    )
    mirror: bool = BoolProperty(name="X-Mirror", description=MIRROR, options={"SKIP_SAVE"})

    def fill_in(self, state: MeshState) -> None:
        """Begin where the border lies now."""
        super().fill_in(state)
        if not self.properties.is_property_set("offset"):
            self.offset = offset_of(state.corrections, self.part)

    def correct(self, state: MeshState) -> None:
        correct_both(state, self.part, self.mirror, lambda now, part: move_border(now, part, self.offset))


def move_border(state: MeshState, part: int, offset: float) -> None:
    """Move the border of a part to a distance from where it was found, 0 to put it back."""
    if part == 0:
        raise Refusal(BODY_IS_WHAT_IS_LEFT)
    refuse_absent(state, part)
    items = state.corrections
    place = place_of_border(items, part)
    if place is not None and items[place].kind == compute.SPLIT:
        moved = replace(items[place], value=-offset)
        part_writer.correct(state, (*items[:place], moved, *items[place + 1 :]), changed=place)
        return
    others = items if place is None else items[:place] + items[place + 1 :]
    if offset == 0:
        part_writer.correct(state, others)
        return
    item = new_item(state, compute.MOVE, part, value=offset)
    corrected_analysis.refuse_without_border(state, item)
    place = len(others) if place is None else place
    part_writer.correct(state, (*others[:place], item, *others[place:]), changed=place)


def place_of_border(items: tuple["compute.Correction", ...], part: int) -> int | None:
    """Return the place of the correction that says where the border of a part lies, if there is one."""
    for place, item in enumerate(items):
        is_split_off = item.kind == compute.SPLIT and item.other == part
        if is_split_off or (item.kind == compute.MOVE and item.part == part):
            return place
    return None


def offset_of(items: tuple["compute.Correction", ...], part: int) -> float:
    """Return how far the border of a part is moved; for a part that was split off, from the border of the whole."""
    place = place_of_border(items, part)
    if place is None:
        return 0.0
    return -items[place].value if items[place].kind == compute.SPLIT else items[place].value


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_move_border,))
