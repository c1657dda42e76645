"""Nested dissection: an order of elimination under which factors stay sparse, from the geometry of the mesh."""

import numpy as np

from ..mesh import Floats, Ints, TriangleMesh

# Recursion stops at parts of about this many triangles.
LEAF_TRIANGLES = 8


def bisect_triangles(mesh: TriangleMesh) -> Ints:
    """Return (T,) codes of the leaves of a recursive bisection; two parts split at bit b differ first in bit b.

    Every part is halved at the median along one of five directions spanned by its principal axes, the one that
    cuts the fewest edges. All parts of one depth are split together.
    """
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    pairs = mesh.edges.neighbours
    code = np.zeros(len(centres), dtype=np.int64)
    for depth in range(_n_levels(len(centres))):
        pairs = pairs[code[pairs[:, 0]] == code[pairs[:, 1]]]
        code = 2 * code + _halve(centres, code, pairs, n_parts=1 << depth)
    return code


def elimination_order(elements: Ints, codes: Ints, n_unknowns: int) -> Ints:
    """Return (N,) the unknowns in their order of elimination, separators after the parts they separate.

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
    return np.lexsort((height, end_of_subtree))


def _n_levels(n_triangles: int) -> int:
    return max(0, int(np.ceil(np.log2(n_triangles / LEAF_TRIANGLES))))


def _halve(centres: Floats, part: Ints, pairs: Ints, n_parts: int) -> Ints:
    """Return 0 or 1 for each triangle: its side of the cheapest median cut of its part."""
    fewest = np.full(n_parts, np.iinfo(np.int64).max)
    best = np.zeros(len(part), dtype=np.int64)
    for direction in _cut_directions(centres, part, n_parts):
        side = _median_side(np.einsum("ij,ij->i", centres, direction[part]), part, n_parts)
        is_cut = side[pairs[:, 0]] != side[pairs[:, 1]]
        n_cut = np.bincount(part[pairs[is_cut, 0]], minlength=n_parts)
        best = np.where((n_cut < fewest)[part], side, best)
        fewest = np.minimum(fewest, n_cut)
    return best


def _cut_directions(centres: Floats, part: Ints, n_parts: int) -> tuple[Floats, ...]:
    """Return five (n_parts, 3) directions: the principal axes, longest first, and the diagonals of the first two."""
    count = np.bincount(part, minlength=n_parts)
    mean = np.stack([np.bincount(part, axis, n_parts) for axis in centres.T], axis=1) / count[:, None]
    offset = centres - mean[part]
    products = np.einsum("ij,ik->ijk", offset, offset).reshape(-1, 9)
    covariance = np.stack([np.bincount(part, column, n_parts) for column in products.T], axis=1)
    axes = np.linalg.eigh(covariance.reshape(-1, 3, 3))[1]
    short, middle, long = (axes[:, :, k] for k in range(3))
    return long, middle, short, long + middle, long - middle


def _median_side(coordinate: Floats, part: Ints, n_parts: int) -> Ints:
    """Return 1 for the upper half of each part along a coordinate, else 0; ties go by index."""
    by_part = np.lexsort((coordinate, part))
    count = np.bincount(part, minlength=n_parts)
    rank = np.empty(len(part), dtype=np.int64)
    rank[by_part] = np.arange(len(part)) - (np.cumsum(count) - count)[part[by_part]]
    return (rank >= count[part] // 2).astype(np.int64)


def _bit_length(numbers: Ints) -> Ints:
    """Return the number of binary digits of each number below 2^53."""
    return np.frexp(numbers.astype(float))[1].astype(np.int64)
