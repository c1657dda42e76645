"""The settings of a mesh that the panel shows: its level, its list of parts, its outputs."""

from collections.abc import Callable
from functools import partial
from typing import Any

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from ... import compute
from ...compute.errors import EngineError
from ..corrections.branch_level import set_branch_level
from ..corrections.move_border import move_border, offset_of
from ..mesh_state import corrected_analysis, part_table, state
from ..messages.unexpected_errors import OUT_OF_MEMORY
from ..messages.user_errors import LINKED, Refusal, is_linked
from ..outputs import output_registry, part_writer
from ..parts.segment import MODE_ITEMS
from ..parts.select import select_faces_of


def _level(settings: "EigenpartsMeshSettings") -> int:
    return _summary_value(settings, "level")


def _n_parts(settings: "EigenpartsMeshSettings") -> int:
    return _summary_value(settings, "n_parts")


def _set_level(settings: "EigenpartsMeshSettings", level: int) -> None:
    highest = max(0, _summary_value(settings, "n_levels") - 1)
    _segment(settings.id_data, level=min(level, highest))


def _set_n_parts(settings: "EigenpartsMeshSettings", n_parts: int) -> None:
    _segment(settings.id_data, n_parts=n_parts)


def _mode(settings: "EigenpartsMeshSettings") -> int:
    return compute.MODES.index(state.mode_of(settings.id_data))


def _set_mode(settings: "EigenpartsMeshSettings", mode: int) -> None:
    _segment(settings.id_data, mode=compute.MODES[mode], level=_level(settings))


def _name(row: "EigenpartsPartRow") -> str:
    return part_table.name_of(row.id_data, row.part)


def _set_name(row: "EigenpartsPartRow", name: str) -> None:
    _told(row.id_data, part_writer.rename_part, row.part, name)


def _colour(row: "EigenpartsPartRow") -> tuple[float, ...]:
    return tuple(part_table.colours(row.id_data, row.part + 1)[row.part, :3])


def _set_colour(row: "EigenpartsPartRow", colour: tuple[float, float, float]) -> None:
    _told(row.id_data, part_writer.colour_part, row.part, tuple(colour))


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


def _tick_box(output: str) -> Any:
    """Return a property that writes an output when it is ticked, and takes it back."""
    name, description, _ = output_registry.OUTPUTS[output]

    def is_chosen(settings: "EigenpartsMeshSettings") -> bool:
        return output in output_registry.chosen(settings.id_data)

    def choose(settings: "EigenpartsMeshSettings", wanted: bool) -> None:
        others = set(output_registry.chosen(settings.id_data)) - {output}
        _told(settings.id_data, part_writer.write_outputs, others | ({output} if wanted else set()))

    return BoolProperty(name=name, description=description, get=is_chosen, set=choose)


def _softness(settings: "EigenpartsMeshSettings") -> float:
    return output_registry.softness(settings.id_data)


def _set_softness(settings: "EigenpartsMeshSettings", width: float) -> None:
    _told(settings.id_data, part_writer.write_outputs, None, width)


def _active_row(settings: "EigenpartsMeshSettings") -> int:
    """Return the row of the active part: rows come and go with the level, the part stays the same."""
    parts = [row.part for row in settings.rows]
    return parts.index(settings.active_part) if settings.active_part in parts else -1


def _set_active_row(settings: "EigenpartsMeshSettings", row: int) -> None:
    if 0 <= row < len(settings.rows):
        settings.active_part = settings.rows[row].part
        _told(settings.id_data, select_faces_of, settings.active_part)


class EigenpartsCorrectionRow(bpy.types.PropertyGroup):
    """A correction in the list of the panel."""

    place: IntProperty(name="Correction", description="Its place in the list, from 0")
    title: StringProperty(name="Correction", description="What was corrected")
    rests: BoolProperty(name="Rests", description="This level has not the parts it belongs to, so it does nothing now")


def _part_level(settings: "EigenpartsMeshSettings") -> int:
    part = settings.active_part
    levels = (
        int(item.value)
        for item in corrected_analysis.items_of(settings.id_data)
        if (item.kind, item.part) == (compute.LEVEL, part)
    )
    return next(levels, _level(settings))


def _set_part_level(settings: "EigenpartsMeshSettings", level: int) -> None:
    highest = max(0, _summary_value(settings, "n_levels") - 1)
    _told(settings.id_data, set_branch_level, settings.active_part, min(level, highest))


def _part_border(settings: "EigenpartsMeshSettings") -> float:
    return offset_of(corrected_analysis.items_of(settings.id_data), settings.active_part)


def _set_part_border(settings: "EigenpartsMeshSettings", offset: float) -> None:
    _told(settings.id_data, move_border, settings.active_part, offset)


class EigenpartsMeshSettings(bpy.types.PropertyGroup):
    """What a mesh shows now; the values live in its state, so they follow it through undo, copies and files."""

    mode: EnumProperty(
        name="Mode",
        description="What becomes a part",
        items=MODE_ITEMS,
        get=_mode,
        set=_set_mode,
    )
    level: IntProperty(
        name="Level",
        description="How many of the most prominent features are parts",
        min=0,
        get=_level,
        set=_set_level,
    )
    n_parts: IntProperty(
        name="Parts",
        description="How many parts the mesh is divided into, the body included",
        min=1,
        get=_n_parts,
        set=_set_n_parts,
    )
    rows: CollectionProperty(type=EigenpartsPartRow)
    active_part: IntProperty(name="Active Part", description="Number of the part that was clicked last", default=-1)
    active_row: IntProperty(
        name="Part",
        description="Click to select the faces of the part and to outline it in the view",
        get=_active_row,
        set=_set_active_row,
    )
    part_level: IntProperty(
        name="Level of Part",
        description="The level that counts inside the part that is active in the list",
        min=0,
        get=_part_level,
        set=_set_part_level,
    )
    part_border: FloatProperty(
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
    correction_rows: CollectionProperty(type=EigenpartsCorrectionRow)
    active_correction: IntProperty(name="Correction", description="A correction; the cross takes it back")
    vertex_attribute: _tick_box("VERTEX_ATTRIBUTE")
    corner_colors: _tick_box("CORNER_COLORS")
    face_sets: _tick_box("FACE_SETS")
    vertex_groups: _tick_box("VERTEX_GROUPS")
    materials: _tick_box("MATERIALS")
    field: _tick_box("FIELD")
    softness: FloatProperty(
        name="Softness",
        description="Width over which vertex groups pass from one part to the next; 0 for hard borders",
        subtype="DISTANCE",
        min=0,
        get=_softness,
        set=_set_softness,
    )


def _summary_value(settings: EigenpartsMeshSettings, name: str) -> int:
    try:
        summary = state.summarize(settings.id_data)
    except Refusal:
        return 0
    return len(summary.parts) if name == "n_parts" else getattr(summary, name)


def _segment(mesh: bpy.types.Mesh, **choice: Any) -> None:
    labels = _told(mesh, partial(part_writer.segment_mesh, **choice))
    if labels is not None:
        bpy.context.window_manager.eigenparts.problem = " ".join(labels.warnings)


def _told(mesh: bpy.types.Mesh, action: Callable[..., Any], *arguments: Any) -> Any:
    """Do something to a mesh at once; a property cannot report, so the panel tells what went wrong."""
    status = bpy.context.window_manager.eigenparts
    status.problem, status.problem_of = "", mesh.name_full
    if is_linked(mesh):
        status.problem = LINKED
        return None
    try:
        return action(mesh, *arguments)
    except (Refusal, EngineError) as error:
        status.problem = str(error)
        return None
    except MemoryError:
        status.problem = OUT_OF_MEMORY
        return None


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (EigenpartsPartRow, EigenpartsCorrectionRow, EigenpartsMeshSettings)
)


def register() -> None:
    """Give meshes their settings."""
    _register_classes()
    bpy.types.Mesh.eigenparts = PointerProperty(type=EigenpartsMeshSettings)


def unregister() -> None:
    """Take the settings away again."""
    del bpy.types.Mesh.eigenparts
    _unregister_classes()
