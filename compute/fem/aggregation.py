"""A coarser space of functions: neighbouring unknowns joined to aggregates, and how their functions are carried back.

Unknowns are joined along edges that carry stiffness, so fingers that touch and shells inside one another never share an
aggregate or a value, and nothing is asked of the topology of the mesh.
"""

import numpy as np
from scipy.sparse import csr_array

from ..surface.mesh import Bools, Floats, Ints, Ints32

# An edge can join two unknowns if it carries at least this part of the stiffness at them: no long side of a needle can.
LEAST_COUPLING = 0.1

# An unknown is at most so many edges from the root of its aggregate, and takes values from as far.
REACH = 2

# Part of the spread of aggregates around an unknown that counts as noise, so that those in a plane have a normal.
FLATNESS = 0.02


def aggregates(stiffness: csr_array) -> Ints32:
    """Return (N,) the aggregate of each unknown, numbered from 0.

    Roots are taken at random, each more than two edges from all others, until every unknown is near one. Their
    neighbours follow them, and the others the one they hold to most.

    References
    ----------
    .. [1] Bell, Dalton, Olson, "Exposing fine-grained parallelism in algebraic multigrid methods", SIAM J. Sci. Comput.
       2012.
    """
    starts, ends, coupling = _strong_edges(stiffness)
    is_root = _roots(starts, ends)
    aggregate = np.full(len(is_root), -1, dtype=np.int32)
    aggregate[is_root] = np.arange(np.count_nonzero(is_root))
    row = np.repeat(np.arange(len(is_root), dtype=np.int32), np.diff(starts, append=len(ends)))
    for _ in range(REACH):
        offered = np.flatnonzero((aggregate[row] < 0) & (aggregate[ends] >= 0))
        offered = offered[np.lexsort((coupling[offered], row[offered]))]
        strongest = offered[np.diff(row[offered], append=-1) != 0]
        aggregate[row[strongest]] = aggregate[ends[strongest]]
    return aggregate


def centres(aggregate: Ints32, positions: Floats) -> Floats:
    """Return (n, 3) the mean position of the unknowns of each aggregate."""
    counts = np.bincount(aggregate)
    return np.stack([np.bincount(aggregate, column) / counts for column in positions.T], axis=1)


def carrying(stiffness: csr_array, aggregate: Ints32, positions: Floats, coarse_positions: Floats) -> csr_array:
    """Return (N, n) the values at the unknowns of the functions that are 1 on one aggregate and 0 on the others.

    They are smoothed by a random walk along the edges, and corrected as little as possible so that functions that are
    linear in space are carried exactly. Without that their eigenvalues are a quarter too large, with it a thousandth.
    """
    n_unknowns = len(aggregate)
    shares = csr_array((np.ones(n_unknowns), aggregate, np.arange(n_unknowns + 1, dtype=np.int32)))
    walk = _walk(stiffness)
    for _ in range(REACH):
        shares = walk @ shares
    return _exact_if_linear(shares, positions, coarse_positions)


def _strong_edges(stiffness: csr_array) -> tuple[Ints, Ints, Floats]:
    """Return where the edges of each unknown start, their ends, itself among them, and how much they carry."""
    diagonal, end = stiffness.diagonal(), stiffness.indices
    row = _rows(stiffness)
    root = np.sqrt(diagonal)
    coupling = -stiffness.data / np.maximum(root[row] * root[end], np.finfo(float).tiny)
    is_strong = (row == end) | (coupling >= LEAST_COUPLING)
    n_ends = np.bincount(row[is_strong], minlength=len(diagonal))
    return np.cumsum(n_ends) - n_ends, end[is_strong], coupling[is_strong]


def _roots(starts: Ints, ends: Ints) -> Bools:
    """Return (N,) the mask of unknowns more than two edges apart, so many that none could be added."""
    n_unknowns = len(starts)
    rank = np.random.default_rng(0).permutation(n_unknowns).astype(np.int32) + 1
    is_root = np.zeros(n_unknowns, dtype=bool)
    while rank.any():
        is_highest = (rank > 0) & (_largest_within_two(rank, starts, ends) == rank)
        is_root |= is_highest
        rank[_largest_within_two(is_highest, starts, ends)] = 0
    return is_root


def _largest_within_two(numbers: Ints, starts: Ints, ends: Ints) -> Ints:
    """Return (N,) the largest of the numbers of the unknowns within two edges of each."""
    for _ in range(2):
        numbers = np.maximum.reduceat(numbers[ends], starts)
    return numbers


def _walk(stiffness: csr_array) -> csr_array:
    """Return (N, N) the step that leaves half of each value and spreads the other half by what the edges carry."""
    row, n_unknowns = _rows(stiffness), stiffness.shape[0]
    is_self = row == stiffness.indices
    carried = np.where(is_self, 0.0, np.maximum(-stiffness.data, 0.0))
    total = np.bincount(row, carried, n_unknowns)
    carried *= (0.5 / np.maximum(total, np.finfo(float).tiny))[row]
    carried[is_self] = np.where(total > 0, 0.5, 1.0)
    return csr_array((carried, stiffness.indices, stiffness.indptr), shape=stiffness.shape)


def _exact_if_linear(shares: csr_array, positions: Floats, coarse_positions: Floats) -> csr_array:
    """Return shares (N, n) whose rows have the sum 1, changed so that they give the positions, too."""
    starts, row, share = shares.indptr[:-1], _rows(shares), shares.data
    offset = [coarse[shares.indices] - fine[row] for coarse, fine in zip(coarse_positions.T, positions.T, strict=True)]
    mean = np.stack([np.add.reduceat(share * column, starts) for column in offset], axis=1)
    for column, mean_column in zip(offset, mean.T, strict=True):
        column -= mean_column[row]
    spread = np.empty((len(mean), 3, 3))
    for k in range(3):
        for j in range(k + 1):
            spread[:, k, j] = spread[:, j, k] = np.add.reduceat(share * offset[k] * offset[j], starts)
    # The distance to the mean counts, too: what lies beyond all aggregates is not reached by large numbers.
    noise = FLATNESS * (np.trace(spread, axis1=1, axis2=2) + (mean**2).sum(axis=1)) + np.finfo(float).tiny
    spread[:, range(3), range(3)] += noise[:, None]
    slope = np.linalg.solve(spread, mean[:, :, None])[:, :, 0]
    change = np.zeros(len(share))
    for column, slope_column in zip(offset, slope.T, strict=True):
        change += slope_column[row] * column
    return csr_array((share * (1 - change), shares.indices, shares.indptr), shape=shares.shape)


def _rows(matrix: csr_array) -> Ints:
    """Return the row of each entry."""
    return np.repeat(np.arange(matrix.shape[0], dtype=np.int32), np.diff(matrix.indptr))
