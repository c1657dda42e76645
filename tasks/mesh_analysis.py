"""A mesh analyzed: all of it that a mesh keeps, or with its field and topology."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import compute
from . import recent_analyses
from .mesh_shape import NO_STRETCH, MeshArrays, Stretch
from .recent_analyses import EngineOptions

# Elements by their order.
ELEMENTS = {1: "Linear", 2: "Quadratic", 3: "Cubic"}


@dataclass(frozen=True, eq=False)
class AnalysisInput:
    """A mesh as it was read, and what its analysis is asked for.

    Attributes
    ----------
    name : str
        Of the object, for the user.
    arrays : MeshArrays
    options : EngineOptions
        Keyword arguments of the engine's analysis.
    n_colours : int
        How many there are for parts.
    """

    name: str
    arrays: MeshArrays
    options: EngineOptions
    n_colours: int


@dataclass(frozen=True, eq=False)
class StoredAnalysis:
    """All that levels are read from.

    Attributes
    ----------
    part_tree : PartTree
        Without the pairs that are noise.
    shells : str
        What was done with loose parts, one of ``compute.SHELLS``.
    stretch : Stretch
        From the mesh to the shape that was analyzed.
    corrections : Corrections, optional
        What was changed by hand; it refers to the branches of this tree.
    """

    part_tree: compute.PartTree
    shells: str
    stretch: Stretch = NO_STRETCH
    corrections: compute.Corrections | None = None


@dataclass(frozen=True, eq=False)
class BorderSource:
    """The heights and arcs that the borders of every level are cut from.

    Attributes
    ----------
    profile : EdgeProfile
        Of the edges of the mesh.
    vertex_heights : (V,) float64
    """

    profile: compute.EdgeProfile
    vertex_heights: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AnalysisResult:
    """The part of an analysis that a mesh keeps.

    Attributes
    ----------
    stored : StoredAnalysis
    source : BorderSource
    description : str
        The field and its elements, in words.
    elements : str, optional
        One of ``ELEMENTS``; None if the field is of values of one's own.
    warnings : tuple of str
    seconds : float
        Time of the analysis.
    polygon_of_triangle : (T,) int64
    place_of_vertex : (V,) int64
        The vertex that stands for each where several lie at one place along a seam.
    swatches : dict of int to int
        The place of each part's colour among those for parts.
    hints : tuple of FunctionHint
    """

    stored: StoredAnalysis
    source: BorderSource
    description: str
    elements: str | None
    warnings: tuple[str, ...]
    seconds: float
    polygon_of_triangle: NDArray[np.int64]
    place_of_vertex: NDArray[np.int64]
    swatches: dict[int, int]
    hints: tuple[compute.FunctionHint, ...] = ()


def analyze(
    given: AnalysisInput,
    progress: compute.Progress,
    analysis_of: Callable[..., compute.Analysis] = recent_analyses.analyze,
) -> AnalysisResult:
    """Run the engine."""
    start = time.perf_counter()
    analysis = analysis_of(given.arrays, given.options, progress)
    return result_of(analysis, given, time.perf_counter() - start)


def result_of(analysis: compute.Analysis, given: AnalysisInput, seconds: float) -> AnalysisResult:
    """Return the part of an analysis that a mesh keeps."""
    part_tree = analysis.part_tree(given.arrays.polygon_of_triangle)
    heights = compute.vertex_heights(analysis.surface, analysis.field)
    is_function = isinstance(given.options["field"], int)
    elements = None if analysis.order is None else ELEMENTS[analysis.order]
    return AnalysisResult(
        stored=StoredAnalysis(part_tree, given.options["shells"], given.arrays.stretch),
        source=BorderSource(analysis.profile(given.arrays.edges), heights),
        description=", ".join(filter(None, (_description(given.options["field"]), elements))),
        elements=elements,
        warnings=analysis.warnings,
        seconds=seconds,
        polygon_of_triangle=given.arrays.polygon_of_triangle,
        place_of_vertex=analysis.surface.vertex_of_input,
        swatches=compute.places_at_all_levels(part_tree, given.n_colours),
        hints=compute.judge_eigenfunctions(analysis.eigenbasis) if is_function else (),
    )


def _description(field: Any) -> str:
    if isinstance(field, int):
        return f"Eigenfunction {field}"
    return "Diffusion" if isinstance(field, str) else "Own values"


@dataclass(frozen=True, eq=False)
class AnalyzedShape:
    """The analysis of a shape, and the stretch from its mesh to it."""

    analysis: compute.Analysis
    stretch: Stretch


def analyze_topology(given: AnalysisInput, progress: compute.Progress) -> AnalyzedShape:
    """Return an analysis with its persistence diagram."""
    analysis = recent_analyses.recall(given.arrays, given.options, progress)
    # The longer part of the topology is made here, in the worker.
    _ = analysis.diagram
    return AnalyzedShape(analysis, given.arrays.stretch)
