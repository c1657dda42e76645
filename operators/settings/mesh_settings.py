"""The settings of a mesh that the panel shows; the values live in its state, so they follow undo, copies and files."""

import bpy
from bpy.props import EnumProperty, IntProperty, PointerProperty

from ... import compute
from ..mesh_state.state import read
from ..outputs import part_writer
from ..parts.choice_items import MODE_ITEMS
from .correction_settings import CorrectionSettings, EigenpartsCorrectionRow
from .output_settings import OutputSettings
from .panel_problems import shown_in_panel
from .part_list import EigenpartsPartRow, PartList


def _mode(settings: "EigenpartsMeshSettings") -> int:
    return compute.MODES.index(read(settings.id_data).mode)


@shown_in_panel
def _set_mode(settings: "EigenpartsMeshSettings", mode: int) -> tuple[str, ...]:
    return part_writer.show_mode(settings.id_data, compute.MODES[mode]).warnings


def _level(settings: "EigenpartsMeshSettings") -> int:
    return read(settings.id_data).shown_level


@shown_in_panel
def _set_level(settings: "EigenpartsMeshSettings", level: int) -> tuple[str, ...]:
    return part_writer.show_level(settings.id_data, level).warnings


def _n_parts(settings: "EigenpartsMeshSettings") -> int:
    return read(settings.id_data).n_parts


@shown_in_panel
def _set_n_parts(settings: "EigenpartsMeshSettings", n_parts: int) -> tuple[str, ...]:
    return part_writer.segment_mesh(settings.id_data, n_parts=n_parts).warnings


class EigenpartsMeshSettings(PartList, CorrectionSettings, OutputSettings, bpy.types.PropertyGroup):
    """What a mesh shows now."""

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
