"""From matched functions to a map of points, from each point of the target to one of the source."""

import numpy as np

from ...progress import Progress, section, silent
from ...surface.mesh import Floats, Ints
from ..eigenfunctions.given_points import PointPairs
from ..eigenfunctions.matching import Matching
from ..eigenfunctions.spectral_shape import SpectralShape, farthest_points
from ..eigenfunctions.zoomout import nearest_points, sample_functions, with_constant, zoom_out

# Sizes of the functional map, the constant included, from a matching to a map of points.
DENSE_SIZES = (50, 60, 72, 86, 100)
DENSE_SAMPLES = 3000


def point_map(
    source: SpectralShape,
    target: SpectralShape,
    matching: Matching,
    progress: Progress = silent,
    pairs: PointPairs | None = None,
) -> Ints:
    """Return (n,) the point of the source that each point of the target corresponds to.

    The map keeps to the source's `DENSE_SAMPLES` farthest points, or corresponds by number for shapes of one topology.
    """
    if matching.same_topology:
        return np.arange(len(target.positions))
    samples = farthest_points(source.positions, DENSE_SAMPLES)
    functional_map = refined_functional_map(source, target, matching, samples, section(progress, 0, 0.7), pairs)
    rest = section(progress, 0.7, 1)
    return samples[nearest_points(functional_map, source.functions[samples], target.functions, rest)]


def refined_functional_map(
    source: SpectralShape,
    target: SpectralShape,
    matching: Matching,
    samples: Ints,
    progress: Progress = silent,
    pairs: PointPairs | None = None,
) -> Floats:
    """Return (k, k) the functional map of a matching, target x source, grown to all functions, the constant included.

    Parameters
    ----------
    source, target : SpectralShape
    matching : Matching
    samples : (s,) int64
        Points of the source that points of the target may correspond to.
    pairs : PointPairs, optional
        Those that were given, which the map is drawn to.
    """
    available = min(source.n_functions, target.n_functions)
    sizes = [min(size, available) for size in DENSE_SIZES]
    target_samples = farthest_points(target.positions, DENSE_SAMPLES)
    given = (None, None) if pairs is None else (source.functions[pairs.source], target.functions[pairs.target])
    source_functions = sample_functions(source.functions[samples], (), given[0])
    target_functions = sample_functions(target.functions[target_samples], sizes, given[1])
    return zoom_out(with_constant(matching.map), source_functions, target_functions, sizes, progress=progress)
