"""ZoomOut: a map of points and a map of functions in turn, with more functions each time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..mesh import Floats, Ints

# Sizes of the functional map, the constant included, from hypotheses to a map that can be judged.
MATCHING_SIZES = (17, 17, 20, 24, 29, 35, 42, 50)
# Query points that are compared with all others at once, which bounds the memory.
CHUNK = 2000


@dataclass(frozen=True, eq=False)
class SampledFunctions:
    """The functions of a shape at its samples, with their least squares fits.

    Attributes
    ----------
    functions : (s, k) float64
    fits : dict of int to (size, s) float64
        Gives the coefficients of the first functions from values at the samples.
    """

    functions: Floats
    fits: dict[int, Floats]


def sample_functions(functions: Floats, sizes: Sequence[int]) -> SampledFunctions:
    """Prepare functions at samples for maps of some sizes."""
    return SampledFunctions(functions, {size: np.linalg.pinv(functions[:, :size]) for size in sorted(set(sizes))})


def zoom_out(start: Floats, source: SampledFunctions, target: SampledFunctions, sizes: Sequence[int]) -> Floats:
    """Return a functional map grown to the last of the sizes.

    Parameters
    ----------
    start : (k, k) float64
        Functional map to begin with, target x source, the constant included.
    source, target : SampledFunctions
    sizes : sequence of int
        Rising; those below k are passed over. The target has a fit for each.

    References
    ----------
    .. [1] Melzi et al., "ZoomOut: Spectral Upsampling for Efficient Shape Correspondence", SIGGRAPH Asia 2019.
    """
    grown = start
    for size in sizes:
        if size >= len(start):
            grown = _step(grown, source, target, size)
    return grown


def _step(grown: Floats, source: SampledFunctions, target: SampledFunctions, size: int) -> Floats:
    matched = source.functions[nearest_points(grown, source.functions, target.functions)]
    return target.fits[size] @ matched[:, :size]


def nearest_points(functional_map: Floats, source: Floats, target: Floats) -> Ints:
    """Return for each target point the source point that is nearest after the map of functions.

    Parameters
    ----------
    functional_map : (kt, ks) float64
    source : (n, at least ks) float64
    target : (m, at least kt) float64
    """
    n_target, n_source = functional_map.shape
    return nearest_rows(target[:, :n_target], source[:, :n_source] @ functional_map.T)


def nearest_rows(queries: Floats, rows: Floats) -> Ints:
    """Return for each query the index of the nearest row."""
    half_norms = np.einsum("ij,ij->i", rows, rows) / 2
    transposed = np.ascontiguousarray(rows.T)
    nearest = np.empty(len(queries), dtype=np.int64)
    for start in range(0, len(queries), CHUNK):
        block = queries[start : start + CHUNK] @ transposed
        block -= half_norms
        nearest[start : start + CHUNK] = block.argmax(axis=1)
    return nearest


def with_constant(functional_map: Floats) -> Floats:
    """Return the map with a row and a column for the constant, which goes to the constant."""
    wider = np.zeros((functional_map.shape[0] + 1, functional_map.shape[1] + 1))
    wider[0, 0] = 1.0
    wider[1:, 1:] = functional_map
    return wider
