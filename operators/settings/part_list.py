"""The list of parts among the settings of a mesh."""

import bpy
from bpy.props import CollectionProperty, FloatProperty, FloatVectorProperty, IntProperty, StringProperty

from ..mesh_state.state import read
from ..outputs import part_writer
from ..parts.select import select_faces_of
from .panel_problems import shown_in_panel


def _name(row: "EigenpartsPartRow") -> str:
    return read(row.id_data).parts.name_of(row.part)


@shown_in_panel
def _set_name(row: "EigenpartsPartRow", name: str) -> None:
    part_writer.rename_part(row.id_data, row.part, name)


def _colour(row: "EigenpartsPartRow") -> tuple[float, ...]:
    return tuple(read(row.id_data).parts.colours_of(row.part + 1)[row.part, :3])


@shown_in_panel
def _set_colour(row: "EigenpartsPartRow", colour: tuple[float, float, float]) -> None:
    part_writer.colour_part(row.id_data, row.part, tuple(colour))


class EigenpartsPartRow(bpy.types.PropertyGroup):
    """A part in the list of the panel."""

    part: IntProperty(name="Number", description="Label of the part; 0 is the body")
    depth: IntProperty(name="Depth", description="How many parts it is a part of")
    share: FloatProperty(name="Area", description="Fraction of the whole area", subtype="FACTOR")
    n_faces: IntProperty(name="Faces", description="How many faces the part has")
    title: StringProperty(
        name="Name",
        description="Name of the part; double-click to change it, empty for the name it had first",
        get=_name,
        set=_set_name,
    )
    color: FloatVectorProperty(
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
    select_faces_of(settings.id_data, part)


class PartList:
    """The parts that a mesh shows, and the one that was clicked last."""

    rows: CollectionProperty(type=EigenpartsPartRow)
    active_part: IntProperty(name="Active Part", description="Number of the part that was clicked last", default=-1)
    active_row: IntProperty(
        name="Part",
        description="Click to select the faces of the part and to outline it in the view",
        get=_active_row,
        set=_set_active_row,
    )
