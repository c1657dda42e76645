"""From matched functions to matched points."""

import numpy as np

from ...progress import Progress, section, silent
from ...surface.mesh import Floats, Ints
from ..eigenfunctions.matching import Matching
from ..eigenfunctions.spectral_shape import SpectralShape, farthest_points
from ..eigenfunctions.zoomout import nearest_points, sample_functions, with_constant, zoom_out

# Sizes of the functional map, the constant included, from a matching to a map of points.
DENSE_SIZES = (50, 60, 72, 86, 100)
DENSE_SAMPLES = 3000


def source_points(
    source: SpectralShape, target: SpectralShape, matching: Matching, progress: Progress = silent
) -> Ints:
    """Return (n,) for each point of the target the point of the source that it corresponds to.

    The map keeps to the source's `DENSE_SAMPLES` farthest points, or corresponds by number for shapes of one topology.
    """
    if matching.same_topology:
        return np.arange(len(target.positions))
    samples = farthest_points(source.positions, DENSE_SAMPLES)
    grown = dense_map(source, target, matching, samples, section(progress, 0, 0.7))
    landing = section(progress, 0.7, 1)
    return samples[nearest_points(grown, source.functions[samples], target.functions, landing)]


def dense_map(
    source: SpectralShape, target: SpectralShape, matching: Matching, samples: Ints, progress: Progress = silent
) -> Floats:
    """Return (k, k) the functional map of a matching, grown to all functions, the constant included.

    Parameters
    ----------
    source, target : SpectralShape
    matching : Matching
    samples : (s,) int64
        Points of the source that points of the target may correspond to.
    """
    available = min(source.n_functions, target.n_functions)
    sizes = [min(size, available) for size in DENSE_SIZES]
    target_samples = farthest_points(target.positions, DENSE_SAMPLES)
    here = sample_functions(source.functions[samples], ())
    there = sample_functions(target.functions[target_samples], sizes)
    return zoom_out(with_constant(matching.map), here, there, sizes, progress=progress)
