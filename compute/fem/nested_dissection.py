"""Nested dissection: an order of elimination under which factors stay sparse, from the geometry of the mesh."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..surface.mesh import Bools, Floats, Ints, TriangleMesh

# Parts of at most this many triangles are not split.
LEAF_TRIANGLES = 8

# A cut is looked for among places that leave each side at least this share of the triangles.
LEAST_SHARE = 0.3

# Rounds of straightening after a cut.
N_ROUNDS = 2

# Places along a direction are told apart this finely, so that they can be sorted by digits.
N_PLACES = 1 << 16


@dataclass(frozen=True, eq=False)
class _Parts:
    """The parts of one depth that are still to be split, one after another.

    Attributes
    ----------
    triangles : (m,) int
        Their triangles, part by part.
    part : (m,) int
        The part of each, ascending from 0.
    pairs : (n, 2) int
        Places in ``triangles`` of neighbours in the same part.
    """

    triangles: Ints
    part: Ints
    pairs: Ints

    @cached_property
    def sizes(self) -> Ints:
        return np.bincount(self.part)

    @cached_property
    def starts(self) -> Ints:
        return np.cumsum(self.sizes) - self.sizes


def bisect_triangles(mesh: TriangleMesh) -> Ints:
    """Return (T,) codes of the leaves of a recursive bisection; two parts split at bit b differ first in bit b.

    Every part is cut across one of its principal axes, at the place not too far from the middle where the fewest edges
    are cut; then the cut is straightened. All parts of one depth are split together.
    """
    n_triangles = len(mesh.triangles)
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    everything = _Parts(np.arange(n_triangles), np.zeros(n_triangles, dtype=np.int64), mesh.edges.neighbours)
    parts = _large(everything)
    code, depth = np.zeros((2, n_triangles), dtype=np.int64)
    while len(parts.triangles):
        is_upper = _straightened(parts, _cut(parts, centres[parts.triangles]))
        code[parts.triangles] = 2 * code[parts.triangles] + is_upper
        depth[parts.triangles] += 1
        parts = _large(_Parts(parts.triangles, 2 * parts.part + is_upper, parts.pairs))
    return code << (depth.max(initial=0) - depth)


def elimination_order(elements: Ints, codes: Ints, n_unknowns: int) -> Ints:
    """Return (N,) the unknowns in their order of elimination, separators after the parts they separate.

    Within a part, unknowns inside triangles come before those on edges, and vertices last: the fewest neighbours first.

    Parameters
    ----------
    elements : (T, n) int
        Unknowns of each triangle.
    codes : (T,) int
        Leaves of the triangles from `bisect_triangles`.
    n_unknowns : int
        Number of unknowns; those without a triangle come last.
    """
    lowest = np.full(n_unknowns, np.iinfo(np.int64).max)
    highest = np.full(n_unknowns, -1)
    of_unknown = np.broadcast_to(codes[:, None], elements.shape)
    np.minimum.at(lowest, elements, of_unknown)
    np.maximum.at(highest, elements, of_unknown)
    has_triangle = highest >= 0
    # An unknown belongs to the smallest subtree that holds all its triangles.
    height = np.where(has_triangle, _bit_length(np.where(has_triangle, lowest ^ highest, 0)), 0)
    end_of_subtree = ((highest >> height) + 1) << height
    end_of_subtree[~has_triangle] = np.iinfo(np.int64).max
    return np.lexsort((-np.arange(n_unknowns), height, end_of_subtree))


def _large(parts: _Parts) -> _Parts:
    """Return the parts that are to be split further, in order and renumbered, without the pairs they cut."""
    sizes = np.bincount(parts.part)
    is_large = sizes > LEAF_TRIANGLES
    kept = np.flatnonzero(is_large[parts.part])
    number = np.cumsum(is_large) - 1
    kept = kept[_by_digits(number[parts.part[kept]])]
    place = np.full(len(parts.part), -1)
    place[kept] = np.arange(len(kept))
    is_inside = parts.part[parts.pairs[:, 0]] == parts.part[parts.pairs[:, 1]]
    pairs = place[parts.pairs[is_inside]]
    return _Parts(parts.triangles[kept], number[parts.part[kept]], pairs[pairs[:, 0] >= 0])


def _cut(parts: _Parts, centres: Floats) -> Bools:
    """Return (m,) the mask of the triangles beyond the best straight cut through their part."""
    fewest = np.full(len(parts.sizes), np.inf)
    is_upper = np.zeros(len(centres), dtype=bool)
    centres = centres - (np.add.reduceat(centres, parts.starts) / parts.sizes[:, None])[parts.part]
    for axis in _principal_axes(parts, centres):
        rank = _rank_along(parts, np.einsum("mi,mi->m", centres, axis[parts.part]))
        cost, place = _cheapest_place(parts, rank)
        is_better = cost < fewest
        fewest[is_better] = cost[is_better]
        is_upper = np.where(is_better[parts.part], rank >= place[parts.part], is_upper)
    return is_upper


def _principal_axes(parts: _Parts, offset: Floats) -> Floats:
    """Return (3, n, 3) directions for each part, the one of its greatest extent first."""
    products = np.add.reduceat(offset[:, :, None] * offset[:, None, :], parts.starts)
    return np.linalg.eigh(products)[1].transpose(2, 0, 1)[::-1]


def _rank_along(parts: _Parts, offset: Floats) -> Ints:
    """Return (m,) the places of the triangles when each part is sorted along a direction."""
    lowest, highest = (extreme.reduceat(offset, parts.starts) for extreme in (np.minimum, np.maximum))
    extent = np.maximum(highest - lowest, np.finfo(float).tiny)
    digits = (offset - lowest[parts.part]) / extent[parts.part] * (N_PLACES - 1)
    order = _by_digits(digits.astype(np.uint16))
    order = order[_by_digits(parts.part[order])]
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return rank


def _cheapest_place(parts: _Parts, rank: Ints) -> tuple[Floats, Ints]:
    """Return the number of edges that the best cut of each part crosses, and the first rank beyond the cut."""
    a, b = rank[parts.pairs.T]
    n_ranks = len(rank)
    n_begun, n_ended = (
        np.bincount(end + 1, minlength=n_ranks + 1)[:n_ranks] for end in (np.minimum(a, b), np.maximum(a, b))
    )
    n_crossed = np.cumsum(n_begun - n_ended)
    share = (np.arange(n_ranks) - parts.starts[parts.part]) / parts.sizes[parts.part]
    # Of equally good cuts the one nearest to the middle.
    imbalance = np.abs(share - 0.5)
    cost = np.where(imbalance <= 0.5 - LEAST_SHARE, n_crossed + imbalance, np.inf)
    least = np.minimum.reduceat(cost, parts.starts)
    places = np.flatnonzero(cost == least[parts.part])
    best = np.zeros(len(least), dtype=np.int64)
    best[parts.part[places]] = places
    return least, best


def _straightened(parts: _Parts, is_upper: Bools) -> Bools:
    """Return the cut after moving triangles that have more neighbours on the other side, so that it zigzags less."""
    straight = is_upper.copy()
    a, b = parts.pairs.T
    for from_upper in (True, False) * N_ROUNDS:
        gain = np.where(straight[a] != straight[b], 1, -1)
        gain_of_triangle = np.bincount(a, gain, len(straight)) + np.bincount(b, gain, len(straight))
        straight[(gain_of_triangle > 0) & (straight == from_upper)] = not from_upper
    # Small parts can be eaten up whole; they keep the cut they had.
    share = np.bincount(parts.part, straight) / parts.sizes
    is_balanced = np.minimum(share, 1 - share) >= LEAST_SHARE / 2
    return np.where(is_balanced[parts.part], straight, is_upper)


def _by_digits(numbers: Ints) -> Ints:
    """Return a stable sorting order of numbers from 0; up to 16 bits are sorted by their digits, in linear time."""
    return np.argsort(numbers.astype(np.min_scalar_type(int(numbers.max(initial=0)))), kind="stable")


def _bit_length(numbers: Ints) -> Ints:
    """Return the number of binary digits of each number below 2^53."""
    return np.frexp(numbers.astype(float))[1].astype(np.int64)
