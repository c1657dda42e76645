"""The settings that this extension registers on Blender's types, as far as other rooms and panels read them.

Blender finds them by name only, so nothing else knows their types. The rooms that register them come later.
"""

# Not evaluated: ``typing`` keeps every ``Rows[...]`` for ever, and with it this module and Blender, which then never
# ends.
from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol, TypeVar

import bpy

# The names of the properties on windows, scenes and meshes.
SETTINGS, SKELETON_SETTINGS, TRANSFER_SETTINGS = "eigenparts", "eigenparts_skeleton", "eigenparts_transfer"
POINT_PAIRS = "eigenparts_points"

Row = TypeVar("Row", covariant=True)


class Rows(Protocol[Row]):
    """A list that the panel shows."""

    def __len__(self) -> int: ...

    def __iter__(self) -> Iterator[Row]: ...

    def __getitem__(self, place: int, /) -> Row: ...

    def add(self) -> Row:
        """Return a new row at the end."""

    def remove(self, place: int, /) -> None:
        """Remove one row."""

    def clear(self) -> None:
        """Remove all rows."""


class PartRow(Protocol):
    """A part in the list."""

    part: int
    depth: int
    share: float
    n_faces: int
    title: str


class CorrectionRow(Protocol):
    """A correction in the list."""

    place: int
    title: str
    rests: bool


class PointPairRow(Protocol):
    """A pair of points: a vertex of each of two objects, and how many these had when it was given."""

    source: bpy.types.Object | None
    source_vertex: int
    n_source: int
    target: bpy.types.Object | None
    target_vertex: int
    n_target: int


class MeshSettings(Protocol):
    """The parts that a mesh shows and its corrections; the outputs are those of the registry."""

    rows: Rows[PartRow]
    active_part: int
    active_row: int
    correction_rows: Rows[CorrectionRow]
    active_correction: int
    mirror: bool


class JobStatus(Protocol):
    """The progress of the running job, and the last problem."""

    is_running: bool
    job: str
    is_picking: bool
    fraction: float
    text: str
    shown: str
    problem: str
    problem_of: str


class AnalysisSettings(Protocol):
    """The options of analyses that start in the panel."""

    field: str
    use_modifiers: bool
    bl_rna: bpy.types.Struct


class TransferSettings(Protocol):
    """The options of transfers that start in the panel."""

    layers: set[str]
    groups: str


def job_status(context: bpy.types.Context) -> JobStatus:
    """Return how far the running job is."""
    return getattr(context.window_manager, SETTINGS)


def mesh_settings(mesh: bpy.types.Mesh) -> MeshSettings:
    """Return what a mesh shows."""
    return getattr(mesh, SETTINGS)


def analysis_settings(context: bpy.types.Context) -> AnalysisSettings:
    """Return the options of analyses."""
    return getattr(context.scene, SETTINGS)


def skeleton_settings(context: bpy.types.Context) -> object:
    """Return the options of skeletons."""
    return getattr(context.scene, SKELETON_SETTINGS)


def point_pairs(context: bpy.types.Context) -> Rows[PointPairRow]:
    """Return the pairs of points that were given in a scene."""
    return getattr(context.scene, POINT_PAIRS)


def transfer_settings(context: bpy.types.Context) -> TransferSettings:
    """Return the options of transfers."""
    return getattr(context.scene, TRANSFER_SETTINGS)
