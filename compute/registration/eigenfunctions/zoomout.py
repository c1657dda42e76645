"""ZoomOut: a map of points and a map of functions in turn, with more functions each time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...progress import Progress, silent
from ...surface.assignment import cheapest_assignment
from ...surface.mesh import Floats, Ints
from ...surface.ties import CHOICE

# Sizes of the functional map, the constant included, from hypotheses to a map that can be scored.
MATCHING_SIZES = (17, 17, 20, 24, 29, 35, 42, 50)
# Query points that are compared with all others at once, which bounds the memory.
CHUNK = 2000
# A point whose partner is known counts as so many samples.
POINT_SAMPLES = 10.0


@dataclass(frozen=True, eq=False)
class SampledFunctions:
    """The functions of a shape at its samples, with their least squares fits.

    Attributes
    ----------
    functions : (s, k) float64
    given : (p, k) float64
        At points whose partners are known, times how many samples each counts as.
    fits : dict of int to (size, s + p) float64
        Gives the coefficients of the first functions from values at the samples and points.
    """

    functions: Floats
    given: Floats
    fits: dict[int, Floats]


def sample_functions(functions: Floats, sizes: Sequence[int], given: Floats | None = None) -> SampledFunctions:
    """Prepare functions at samples, and (p, k) at points whose partners are known, for maps of some sizes."""
    given = functions[:0] if given is None else POINT_SAMPLES * given
    rows = np.vstack([functions, given])
    return SampledFunctions(functions, given, {size: np.linalg.pinv(rows[:, :size]) for size in sorted(set(sizes))})


def zoom_out(
    start: Floats,
    source: SampledFunctions,
    target: SampledFunctions,
    sizes: Sequence[int],
    signs: Mapping[int, int] | None = None,
    progress: Progress = silent,
) -> Floats:
    """Return a functional map grown to the last of the sizes.

    Parameters
    ----------
    start : (k, k) float64
        Functional map to begin with, target x source, the constant included.
    source, target : SampledFunctions
    sizes : sequence of int
        Rising; those below k are passed over. The target has a fit for each.
    signs : mapping of int to +1 or -1, optional
        Signs that some of the source's functions keep all along, by the function from 0, the constant left out.
    progress : Progress, optional
        Told before each size; may raise `Cancelled`.

    References
    ----------
    .. [1] Melzi et al., "ZoomOut: Spectral Upsampling for Efficient Shape Correspondence", SIGGRAPH Asia 2019.
    """
    functional_map = start
    for number, size in enumerate(sizes):
        progress(number / len(sizes), "Refining the map")
        if size >= len(start):
            functional_map = with_signs(_step(functional_map, source, target, size), signs or {})
    return functional_map


def _step(functional_map: Floats, source: SampledFunctions, target: SampledFunctions, size: int) -> Floats:
    matched = source.functions[nearest_points(functional_map, source.functions, target.functions)]
    return target.fits[size] @ np.vstack([matched, source.given])[:, :size]


def nearest_points(functional_map: Floats, source: Floats, target: Floats, progress: Progress = silent) -> Ints:
    """Return (m,) the source point that is nearest to each target point after the map of functions.

    Parameters
    ----------
    functional_map : (kt, ks) float64
    source : (n, at least ks) float64
    target : (m, at least kt) float64
    progress : Progress, optional
        Told several times a second; may raise `Cancelled`.
    """
    n_target, n_source = functional_map.shape
    return nearest_rows(target[:, :n_target], source[:, :n_source] @ functional_map.T, progress)


def nearest_rows(queries: Floats, rows: Floats, progress: Progress = silent) -> Ints:
    """Return for each query the index of the nearest row."""
    half_norms = np.einsum("ij,ij->i", rows, rows) / 2
    transposed = np.ascontiguousarray(rows.T)
    nearest = np.empty(len(queries), dtype=np.int64)
    for start in range(0, len(queries), CHUNK):
        progress(start / len(queries), "Finding the nearest points")
        block = queries[start : start + CHUNK] @ transposed
        block -= half_norms
        nearest[start : start + CHUNK] = block.argmax(axis=1)
    return nearest


def rounded(functional_map: Floats) -> tuple[Ints, Ints]:
    """Return (ks,) the target's function that each of the source's mostly is, and +1 or -1: a map as order and sign."""
    order = assigned(-np.abs(functional_map.T))
    entries = functional_map[order, np.arange(len(order))]
    return order, np.where(entries < 0, -1, 1)


def assigned(costs: Floats) -> Ints:
    """Return (k,) the column of each row in the cheapest assignment, of equally cheap ones the nearest to the diagonal.

    Parameters
    ----------
    costs : (k, at least k) float64
    """
    row, column = np.indices(costs.shape)
    return cheapest_assignment(costs + CHOICE * np.abs(row - column) / costs.shape[1])[1]


def with_signs(functional_map: Floats, signs: Mapping[int, int]) -> Floats:
    """Return a map, the constant included, in which given functions of the source have the given signs."""
    if not signs:
        return functional_map
    present = rounded(functional_map[1:, 1:])[1]
    turn = np.ones(functional_map.shape[1])
    for function, sign in signs.items():
        turn[1 + function] = sign * present[function]
    return functional_map * turn


def with_constant(functional_map: Floats) -> Floats:
    """Return the map with a row and a column for the constant, which goes to the constant."""
    wider = np.zeros((functional_map.shape[0] + 1, functional_map.shape[1] + 1))
    wider[0, 0] = 1.0
    wider[1:, 1:] = functional_map
    return wider
