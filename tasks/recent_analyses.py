"""The analyses made last, kept while Blender runs: what is made of the same mesh afterwards then needs no new one."""

from __future__ import annotations

from operator import itemgetter
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from .. import compute
from .mesh_shape import MeshArrays
from .recent_results import Recent, key_of

# All their vertices together; each takes 1 to 10 kB, by the order of the elements.
RECENT_VERTICES = 200_000


class EngineOptions(TypedDict):
    """The options of an analysis, as keyword arguments of the engine."""

    field: str | int | NDArray[np.float64]
    order: int | str
    boundary: str
    shells: str
    borders: str


_recent: Recent[compute.Analysis] = Recent("analyses", RECENT_VERTICES)


def analyze(arrays: MeshArrays, options: EngineOptions, progress: compute.Progress) -> compute.Analysis:
    """Return a new analysis."""
    return compute.analyze(compute.TriangleMesh(arrays.vertices, arrays.triangles), **options, progress=progress)


def analyze_and_keep(arrays: MeshArrays, options: EngineOptions, progress: compute.Progress) -> compute.Analysis:
    """Return a new analysis, and keep it."""
    analysis = analyze(arrays, options, progress)
    _recent.put(key_of_analysis(arrays, options), analysis, len(arrays.vertices))
    return analysis


def recall(arrays: MeshArrays, options: EngineOptions, progress: compute.Progress) -> compute.Analysis:
    """Return the analysis that was made before, a new one if it is not here any more."""
    return _recent.get(key_of_analysis(arrays, options)) or analyze_and_keep(arrays, options, progress)


def reuse(arrays: MeshArrays, options: EngineOptions, progress: compute.Progress) -> compute.Analysis:
    """Return the analysis that was made before, or a new one that is not kept."""
    return _recent.get(key_of_analysis(arrays, options)) or analyze(arrays, options, progress)


def key_of_analysis(arrays: MeshArrays, options: EngineOptions) -> str:
    """Return a text that is the same for the same mesh and options."""
    chosen = (entry for option in sorted(options.items(), key=itemgetter(0)) for entry in option)
    return key_of([arrays.vertices, arrays.triangles, *chosen])
