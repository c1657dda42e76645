"""Corrections by hand of the active part, and the list of all of them, among the settings of a mesh."""

import bpy

from ... import compute
from ..blender.known_values import mesh_with
from ..blender.mixins import GroupMixin
from ..blender.registered_settings import Rows
from ..blender.typed_properties import (
    BoolProperty,
    CollectionProperty,
    FloatProperty,
    IntProperty,
    StringProperty,
    TypedProperties,
)
from ..corrections.both_sides import MIRROR, correct_both
from ..corrections.branch_level import set_branch_level
from ..corrections.move_border import move_border, offset_of
from ..mesh_state.state import read
from .panel_problems import shown_in_panel


class EigenpartsCorrectionRow(TypedProperties, bpy.types.PropertyGroup):
    """A correction in the list of the panel."""

    place: int = IntProperty(name="Correction", description="Its place in the list, from 0")
    title: str = StringProperty(name="Correction", description="What was corrected")
    rests: bool = BoolProperty(
        name="Rests", description="This level has not the parts it belongs to, so it does nothing now"
    )


def _part_level(settings: "CorrectionSettings") -> int:
    state, part = read(mesh_with(settings)), settings.active_part
    levels = (int(item.value) for item in state.corrections if (item.kind, item.part) == (compute.LEVEL, part))
    return next(levels, state.shown_level)


@shown_in_panel
def _set_part_level(settings: "CorrectionSettings", level: int) -> None:
    state = read(mesh_with(settings))
    set_branch_level(state, settings.active_part, min(level, state.highest_level))


def _part_border(settings: "CorrectionSettings") -> float:
    return offset_of(read(mesh_with(settings)).corrections, settings.active_part)


@shown_in_panel
def _set_part_border(settings: "CorrectionSettings", offset: float) -> None:
    state, part = read(mesh_with(settings)), settings.active_part
    correct_both(state, part, settings.mirror, lambda now, one: move_border(now, one, offset))


class CorrectionSettings(TypedProperties, GroupMixin):
    """The level inside the active part, its border, and all corrections."""

    # One of the list of parts.
    active_part: int
    part_level: int = IntProperty(
        name="Level of Part",
        description="The level that counts inside the part that is active in the list",
        min=0,
        get=_part_level,
        set=_set_part_level,
    )
    part_border: float = FloatProperty(
        name="Border",
        description="How far the border of the active part is moved, as a fraction of the field's range; the part grows"
        " with it",
        soft_min=-0.3,
        soft_max=0.3,
        min=-1,
        max=1,
        precision=3,
        step=0.2,
        get=_part_border,
        set=_set_part_border,
    )
    mirror: bool = BoolProperty(name="X-Mirror", description=MIRROR)
    correction_rows: "Rows[EigenpartsCorrectionRow]" = CollectionProperty(type=EigenpartsCorrectionRow)
    active_correction: int = IntProperty(name="Correction", description="A correction; the cross takes it back")
