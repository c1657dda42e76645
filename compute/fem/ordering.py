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
    n_levels = _n_levels(len(centres))
    # Parts of equal size, so that they are the rows of one array; a few triangles stand in it twice.
    size = -(-len(centres) // (1 << n_levels)) << n_levels
    parts = np.resize(np.arange(len(centres)), (1, size))
    code = np.zeros(len(centres), dtype=np.int64)
    for _ in range(n_levels):
        pairs = pairs[code[pairs[:, 0]] == code[pairs[:, 1]]]
        parts = _halved(parts, centres, code, pairs)
        code[parts] = np.arange(len(parts))[:, None]
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


def _halved(parts: Ints, centres: Floats, code: Ints, pairs: Ints) -> Ints:
    """Return (2 n, m / 2) triangles of the halves of (n, m) parts, cut where it costs the fewest edges."""
    n_parts, size = parts.shape
    places = centres[parts]
    fewest = np.full(n_parts, np.iinfo(np.int64).max)
    best = np.zeros(parts.shape, dtype=np.int64)
    for direction in _cut_directions(places):
        by_place = np.argpartition(np.einsum("pmi,pi->pm", places, direction), size // 2, axis=1)
        is_upper = np.zeros(len(centres), dtype=bool)
        is_upper[np.take_along_axis(parts, by_place[:, size // 2 :], axis=1)] = True
        is_cut = is_upper[pairs[:, 0]] != is_upper[pairs[:, 1]]
        n_cut = np.bincount(code[pairs[is_cut, 0]], minlength=n_parts)
        best = np.where((n_cut < fewest)[:, None], by_place, best)
        fewest = np.minimum(fewest, n_cut)
    return np.take_along_axis(parts, best, axis=1).reshape(2 * n_parts, size // 2)


def _cut_directions(places: Floats) -> tuple[Floats, ...]:
    """Return five (n, 3) directions: the principal axes, longest first, and the diagonals of the first two."""
    offset = places - places.mean(axis=1, keepdims=True)
    axes = np.linalg.eigh(offset.swapaxes(1, 2) @ offset)[1]
    short, middle, long = (axes[:, :, k] for k in range(3))
    return long, middle, short, long + middle, long - middle


def _bit_length(numbers: Ints) -> Ints:
    """Return the number of binary digits of each number below 2^53."""
    return np.frexp(numbers.astype(float))[1].astype(np.int64)
