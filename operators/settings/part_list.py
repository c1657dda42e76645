"""The list of parts among the settings of a mesh."""

from collections.abc import Sequence

import bpy

from ..blender.known_values import mesh_with
from ..blender.mixins import GroupMixin
from ..blender.registered_settings import Rows
from ..blender.typed_properties import (
    CollectionProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    StringProperty,
    TypedProperties,
)
from ..mesh_state.state import read
from ..outputs import part_writer
from ..parts.select import select_faces_of
from .panel_problems import shown_in_panel


def _name(row: "EigenpartsPartRow") -> str:
    return read(mesh_with(row)).parts.name_of(row.part)


@shown_in_panel
def _set_name(row: "EigenpartsPartRow", name: str) -> None:
    part_writer.rename_part(mesh_with(row), row.part, name)


def _colour(row: "EigenpartsPartRow") -> tuple[float, ...]:
    return tuple(read(mesh_with(row)).part_colours.colours_of(row.part + 1)[row.part, :3])


@shown_in_panel
def _set_colour(row: "EigenpartsPartRow", colour: Sequence[float]) -> None:
    red, green, blue = colour
    part_writer.colour_part(mesh_with(row), row.part, (red, green, blue))


class EigenpartsPartRow(TypedProperties, bpy.types.PropertyGroup):
    """A part in the list of the panel."""

    part: int = IntProperty(name="Number", description="Label of the part; 0 is the body")
    depth: int = IntProperty(name="Depth", description="How many parts it is a part of")
    share: float = FloatProperty(name="Area", description="Fraction of the whole area", subtype="FACTOR")
    n_faces: int = IntProperty(name="Faces", description="How many faces the part has")
    title: str = StringProperty(
        name="Name",
        description="Name of the part; double-click to change it, empty for the name it had first",
        get=_name,
        set=_set_name,
    )
    color: tuple[float, float, float] = FloatVectorProperty(
        name="Color",
        description="Color of the part; click to change it",
        subtype="COLOR",
        size=3,
        min=0,
        max=1,
        get=_colour,
        set=_set_colour,
    )


def _active_row(settings: "PartList") -> int:
    """Return the row of the active part: rows come and go with the level, the part stays the same."""
    parts = [row.part for row in settings.rows]
    return parts.index(settings.active_part) if settings.active_part in parts else -1


def _set_active_row(settings: "PartList", row: int) -> None:
    if 0 <= row < len(settings.rows):
        settings.active_part = settings.rows[row].part
        _select_active_part(settings, settings.active_part)


@shown_in_panel
def _select_active_part(settings: "PartList", part: int) -> None:
    select_faces_of(mesh_with(settings), part)


class PartList(TypedProperties, GroupMixin):
    """The parts that a mesh shows, and the one that was clicked last."""

    rows: "Rows[EigenpartsPartRow]" = CollectionProperty(type=EigenpartsPartRow)
    active_part: int = IntProperty(
        name="Active Part", description="Number of the part that was clicked last", default=-1
    )
    active_row: int = IntProperty(
        name="Part",
        description="Click to select the faces of the part and to outline it in the view",
        get=_active_row,
        set=_set_active_row,
    )
