"""The settings of a mesh that the panel shows; the values live in its state, so they follow undo, copies and files."""

import bpy
from bpy.props import PointerProperty

from ... import compute
from ..blender.known_values import mesh_with
from ..blender.registered_settings import SETTINGS
from ..blender.typed_properties import BoolProperty, EnumProperty, IntProperty, TypedProperties
from ..mesh_state.state import read
from ..outputs import part_writer
from ..parts.choice_items import JOINTS, MODE_ITEMS
from .correction_settings import CorrectionSettings, EigenpartsCorrectionRow
from .output_settings import OutputSettings
from .panel_problems import shown_in_panel
from .part_list import EigenpartsPartRow, PartList


def _mode(settings: "EigenpartsMeshSettings") -> int:
    return compute.MODES.index(compute.mode_of(read(mesh_with(settings)).mode))


@shown_in_panel
def _set_mode(settings: "EigenpartsMeshSettings", mode: int) -> tuple[str, ...]:
    return part_writer.show_mode(mesh_with(settings), compute.reading_of(compute.MODES[mode], None)).warnings


def _joints(settings: "EigenpartsMeshSettings") -> bool:
    return read(mesh_with(settings)).mode == compute.JOINTED


@shown_in_panel
def _set_joints(settings: "EigenpartsMeshSettings", joints: bool) -> tuple[str, ...]:
    reading = compute.reading_of(compute.mode_of(read(mesh_with(settings)).mode), joints)
    return part_writer.show_mode(mesh_with(settings), reading).warnings


def _level(settings: "EigenpartsMeshSettings") -> int:
    return read(mesh_with(settings)).shown_level


@shown_in_panel
def _set_level(settings: "EigenpartsMeshSettings", level: int) -> tuple[str, ...]:
    return part_writer.show_level(mesh_with(settings), level).warnings


def _n_parts(settings: "EigenpartsMeshSettings") -> int:
    return read(mesh_with(settings)).n_parts


@shown_in_panel
def _set_n_parts(settings: "EigenpartsMeshSettings", n_parts: int) -> tuple[str, ...]:
    return part_writer.segment_mesh(mesh_with(settings), n_parts=n_parts).warnings


class EigenpartsMeshSettings(PartList, CorrectionSettings, OutputSettings, TypedProperties, bpy.types.PropertyGroup):
    """Level, parts, corrections and outputs of a mesh."""

    mode: str = EnumProperty(
        name="Mode",
        description="What becomes a part",
        items=MODE_ITEMS,
        get=_mode,
        set=_set_mode,
    )
    joints: bool = BoolProperty(
        name="Joints",
        description=JOINTS,
        get=_joints,
        set=_set_joints,
    )
    level: int = IntProperty(
        name="Level",
        description="How many of the most prominent features are parts",
        min=0,
        get=_level,
        set=_set_level,
    )
    n_parts: int = IntProperty(
        name="Parts",
        description="How many parts the mesh is divided into, the body included",
        min=1,
        get=_n_parts,
        set=_set_n_parts,
    )


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (EigenpartsPartRow, EigenpartsCorrectionRow, EigenpartsMeshSettings)
)


def register() -> None:
    """Give meshes their settings."""
    _register_classes()
    setattr(bpy.types.Mesh, SETTINGS, PointerProperty(type=EigenpartsMeshSettings))


def unregister() -> None:
    """Take the settings away again."""
    delattr(bpy.types.Mesh, SETTINGS)
    _unregister_classes()
