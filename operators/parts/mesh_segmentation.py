"""Use case: a mesh analyzed and divided into parts, the same from the window, from scripts and on the command line.

``read`` takes what is needed from an object, `mesh_analysis` computes on values alone, in any process, and ``write``
puts the result on the mesh and returns what is to be told.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ... import compute
from ...tasks.level_choice import LevelChoice
from ...tasks.mesh_analysis import AnalysisInput, AnalysisResult
from ..blender.known_values import mesh_of
from ..mesh_state import analysis_writer, function_hints, state
from ..messages.sentences import Messages
from ..outputs import output_registry, part_writer
from ..outputs.rollback import all_or_nothing
from .analysis_settings import AnalysisSettings, read_input


@dataclass(frozen=True, eq=False)
class Segmented:
    """A mesh that was divided: its parts, and the sentences to be told."""

    labels: compute.BranchLabels
    messages: Messages


def read(context: bpy.types.Context, obj: bpy.types.Object, settings: AnalysisSettings) -> AnalysisInput:
    """Return what the analysis of an object needs.

    Raises
    ------
    Refusal
        If something of the user's stands where results belong, or the settings do not fit the mesh.
    """
    output_registry.refuse_foreign_results(state.read(mesh_of(obj)))
    return read_input(context, obj, settings)


def write(
    mesh: bpy.types.Mesh,
    result: AnalysisResult,
    *,
    mode: str | None = None,
    choice: LevelChoice | None = None,
) -> Segmented:
    """Put an analysis on its mesh and divide it into parts; all of it is written or nothing.

    Parameters
    ----------
    mode : str, optional
        How levels are read; as the mesh was divided before if None.
    choice : LevelChoice, optional
        One of ``level``, ``threshold`` and ``n_parts``; the default level if there is none.
    """
    with all_or_nothing(mesh):
        told = store(mesh, result)
        labels = part_writer.segment_mesh(mesh, mode=mode, **(choice or {}))
    n_parts, seconds = len(labels.parts), result.seconds
    is_divided = f"{n_parts} parts ({seconds:.1f} s)."
    is_whole = f"No features: the mesh is one part ({seconds:.1f} s)."
    hint = function_hints.sentence(function_hints.rows_of(result.hints))
    infos = (is_divided if n_parts > 1 else is_whole, hint)
    return Segmented(labels, Messages(infos, (*result.warnings, *told, *labels.warnings)))


def store(mesh: bpy.types.Mesh, result: AnalysisResult) -> tuple[str, ...]:
    """Put an analysis on its mesh without dividing it, and return warnings for the user."""
    return analysis_writer.store(
        *(mesh, result.stored, result.source, result.description, result.hints),
        place_of_vertex=result.place_of_vertex,
        swatches=result.swatches,
    )
