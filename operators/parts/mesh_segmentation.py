"""Use case: a mesh analyzed and divided into parts, the same from the window, from scripts and on the command line.

``read`` takes what is needed from an object, ``analyze`` computes on values alone, in any process, and ``write`` puts
the result on the mesh and returns what is to be told.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ..blender.known_values import mesh_of
from ..jobs import recent_analyses
from ..mesh_state import analysis_writer, function_hints, state
from ..mesh_state.stored_analysis import BorderSource, StoredAnalysis
from ..messages.sentences import Messages
from ..outputs import output_registry, part_writer
from ..outputs.level_choice import LevelChoice
from ..outputs.rollback import all_or_nothing
from .analysis_settings import AnalysisInput, AnalysisSettings, read_input


@dataclass(frozen=True, eq=False)
class AnalysisResult:
    """The part of an analysis that a mesh keeps.

    Attributes
    ----------
    stored : StoredAnalysis
    source : BorderSource
    description : str
        The field, in words.
    warnings : tuple of str
    seconds : float
        Time of the analysis.
    polygon_of_triangle : (T,) int64
    place_of_vertex : (V,) int64
        The vertex that stands for each where several lie at one place along a seam.
    hints : tuple of FunctionHint
    """

    stored: StoredAnalysis
    source: BorderSource
    description: str
    warnings: tuple[str, ...]
    seconds: float
    polygon_of_triangle: NDArray[np.int64]
    place_of_vertex: NDArray[np.int64]
    hints: tuple[compute.FunctionHint, ...] = ()


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


def analyze(
    given: AnalysisInput,
    progress: compute.Progress,
    analysis_of: Callable[..., compute.Analysis] = recent_analyses.analyze,
) -> AnalysisResult:
    """Run the engine; knows nothing of Blender, so any process may do it."""
    start = time.perf_counter()
    analysis = analysis_of(given.arrays, given.options, progress)
    return result_of(analysis, given, time.perf_counter() - start)


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
        *(mesh, result.stored, result.source, result.description, result.hints), place_of_vertex=result.place_of_vertex
    )


def result_of(analysis: compute.Analysis, given: AnalysisInput, seconds: float) -> AnalysisResult:
    """Return the part of an analysis that a mesh keeps; knows nothing of Blender either."""
    part_tree = analysis.part_tree(given.arrays.polygon_of_triangle)
    heights = compute.vertex_heights(analysis.surface, analysis.field)
    is_function = isinstance(given.options["field"], int)
    return AnalysisResult(
        stored=StoredAnalysis(part_tree, given.options["shells"], given.arrays.stretch),
        source=BorderSource(analysis.profile(given.arrays.edges), heights),
        description=_description(given.options["field"]),
        warnings=analysis.warnings,
        seconds=seconds,
        polygon_of_triangle=given.arrays.polygon_of_triangle,
        place_of_vertex=analysis.surface.vertex_of_input,
        hints=compute.judge_eigenfunctions(analysis.eigenbasis) if is_function else (),
    )


def _description(field: Any) -> str:
    if isinstance(field, int):
        return f"Eigenfunction {field}"
    return "Diffusion" if isinstance(field, str) else "Own values"
