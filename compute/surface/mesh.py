"""Triangle meshes: the checked input of the engine."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components

from ..errors import MeshError
from .ties import evened

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Ints32 = NDArray[np.int32]

# Larger coordinates and values have powers that are no numbers any more, and so have areas below the inverse square.
LARGEST_NUMBER = 1e60
SMALLEST_AREA = LARGEST_NUMBER**-2


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of a triangle mesh.

    Attributes
    ----------
    vertices : (E, 2) int64
        End points, the smaller index first.
    of_triangle : (T, 3) int64
        Edge k of a triangle joins its corners k and k + 1.
    n_triangles : (E,) int64
        Number of triangles that meet at each edge; 1 on the boundary, more than 2 where non-manifold.
    """

    vertices: Ints
    of_triangle: Ints
    n_triangles: Ints

    @cached_property
    def neighbours(self) -> Ints:
        """(P, 2) pairs of triangles that share an edge, every pair of a non-manifold edge's fan in a row."""
        triangle = _counting_order(self.of_triangle.ravel(), len(self.vertices)).astype(np.int64) // 3
        is_last = np.zeros(len(triangle), dtype=bool)
        is_last[np.cumsum(self.n_triangles) - 1] = True
        same = np.flatnonzero(~is_last)
        return np.stack([triangle[same], triangle[same + 1]], axis=1)

    @cached_property
    def shared(self) -> Ints:
        """(P,) the edge that each row of ``neighbours`` shares."""
        return np.repeat(np.arange(len(self.vertices)), self.n_triangles - 1)


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """A triangle mesh in space, of any quality: several components, open, flipped, non-manifold.

    Parameters
    ----------
    vertices : (V, 3) float
        Positions in any unit of length. Those that no triangle uses may be anything, NaN too: they are kept within the
        box around the others, so that they never matter.
    triangles : (T, 3) int
        Vertex indices, counter-clockwise seen from outside.

    Raises
    ------
    MeshError
        If there are no triangles, an index has no vertex, a used coordinate is not finite, the area is zero or the
        mesh is so large or so small that its areas are no numbers any more.

    Examples
    --------
    >>> from compute import TriangleMesh
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> square.areas.tolist(), len(square.edges.vertices)
    ([0.5, 0.5], 5)
    """

    vertices: Floats
    triangles: Ints

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike) -> None:
        places, corners = _as_rows(vertices, np.float64, "vertices"), _as_rows(triangles, np.int64, "triangles")
        _check_corners(corners, len(places))
        object.__setattr__(self, "vertices", with_loose_inside(places, corners))
        object.__setattr__(self, "triangles", corners)
        _check_extent(self)

    @cached_property
    def used(self) -> Ints:
        """(U,) the vertices of the triangles, rising."""
        return np.flatnonzero(_is_used(self.triangles, len(self.vertices)))

    @cached_property
    def areas(self) -> Floats:
        """(T,) area of each triangle, in length²."""
        # Scaled by the longest side first, so that tiny and huge units neither underflow nor overflow.
        first, second = self._sides
        scale = max(np.abs(first).max(), np.abs(second).max(), np.finfo(float).tiny)
        (ax, ay, az), (bx, by, bz) = first / scale, second / scale
        x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        return 0.5 * np.sqrt(x * x + y * y + z * z) * scale**2

    @cached_property
    def edges(self) -> Edges:
        """The edges, numbered by their end points."""
        return edges_of(self.triangles, len(self.vertices))

    @cached_property
    def component_of_triangle(self) -> Ints:
        """(T,) the component of each triangle, numbered by falling area; a shared vertex connects."""
        corners = self.triangles
        n_vertices = len(self.vertices)
        sides = np.concatenate([corners[:, :2], corners[:, 1:]])
        label = connected_pieces(sides[:, 0], sides[:, 1], n_vertices)[corners[:, 0]]
        _, label = np.unique(label, return_inverse=True)
        by_area = np.argsort(-evened(np.bincount(label, self.areas)), kind="stable")
        return np.argsort(by_area, kind="stable")[label]

    @property
    def _sides(self) -> tuple[Floats, Floats]:
        """(3, T) the two sides of each triangle that begin at its first corner, one coordinate in a row."""
        # Rows of numbers are several times as fast as many rows of three.
        a, b, c = (np.ascontiguousarray(self.vertices.T)[:, corner] for corner in self.triangles.T)
        return b - a, c - a


def edges_of(triangles: Ints, n_vertices: int) -> Edges:
    """Return the edges of triangles over ``n_vertices`` vertices."""
    order, ends, is_new = sorted_sides(triangles, n_vertices)
    first = np.flatnonzero(is_new)
    edge = np.empty(len(order), dtype=np.int64)
    edge[order] = np.cumsum(is_new) - 1
    return Edges(ends[:, first].T.astype(np.int64), edge.reshape(-1, 3), np.diff(np.append(first, len(order))))


def sorted_sides(triangles: Ints, n_vertices: int) -> tuple[Ints32, Ints32, Bools]:
    """Sort the sides of all triangles by their lower, then by their higher end, so that an edge is a run of sides.

    Returns
    -------
    order : (3 T,) int32
        Side 3 t + k joins the corners k and k + 1 of triangle t.
    ends : (2, 3 T) int32
        Lower and higher end of the sides in that order.
    is_new : (3 T,) bool
        Whether a side is the first of its edge.
    """
    tails = triangles.astype(np.int32)
    heads = np.roll(tails, -1, axis=1)
    low, high = np.minimum(tails, heads).ravel(), np.maximum(tails, heads).ravel()
    order = _counting_order(high, n_vertices)
    order = order[_counting_order(low[order], n_vertices)]
    low, high = low[order], high[order]
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
    return order, np.stack([low, high]), is_new


def _counting_order(keys: Ints | Ints32, n_keys: int) -> Ints32:
    """Return the stable order of keys below ``n_keys``; a sparse transposition is a counting sort, so linear."""
    rows = np.arange(len(keys) + 1, dtype=np.int32)
    one_a_row = csr_array((np.empty(len(keys), dtype=np.int8), keys, rows), shape=(len(keys), n_keys))
    return one_a_row.tocsc().indices


def _as_rows(values: ArrayLike, dtype: type, name: str) -> NDArray[Any]:
    try:
        rows: NDArray[Any] = np.ascontiguousarray(np.asarray(values).astype(dtype, casting="same_kind"))
    except (TypeError, ValueError) as error:
        raise MeshError(f"The {name} must be an array of numbers of shape (n, 3).") from error
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise MeshError(f"The {name} must have the shape (n, 3), not {rows.shape}.")
    return rows


def with_loose_inside(places: Floats, triangles: Ints) -> Floats:
    """Return places (V, 3), those that no triangle uses moved into the box around the others.

    So whatever is measured over all vertices is that of the surface, and none is nowhere or far away.

    Raises
    ------
    MeshError
        If a place that is used is not finite.
    """
    is_used = _is_used(triangles, len(places))
    used = places if is_used.all() else places[is_used]
    if not np.isfinite(used).all():
        raise MeshError("A vertex has a coordinate that is not a finite number; repair or delete it.")
    if is_used.all():
        return places
    low, high = used.min(axis=0), used.max(axis=0)
    inside = places.copy()
    loose = places[~is_used]
    inside[~is_used] = np.clip(np.where(np.isnan(loose), low, loose), low, high)
    return inside


def checked_labels(mesh: TriangleMesh, labels: ArrayLike) -> NDArray[np.int32]:
    """Return the parts of the triangles as whole numbers.

    Raises
    ------
    MeshError
        If there is not one for each triangle, zero or more.
    """
    numbers = np.asarray(labels)
    n_triangles = len(mesh.triangles)
    if numbers.shape != (n_triangles,) or numbers.dtype.kind not in "iu" or numbers.min() < 0:
        raise MeshError(f"The parts need a whole number, zero or more, for each of the {n_triangles} triangles.")
    return numbers.astype(np.int32)


def _is_used(triangles: Ints, n_vertices: int) -> Bools:
    is_used = np.zeros(n_vertices, dtype=bool)
    is_used[triangles] = True
    return is_used


def _check_corners(triangles: Ints, n_vertices: int) -> None:
    if len(triangles) == 0:
        raise MeshError("The mesh has no faces; there is nothing to analyze.")
    if triangles.min() < 0 or triangles.max() >= n_vertices:
        raise MeshError("A triangle refers to a vertex that does not exist.")


def _check_extent(mesh: TriangleMesh) -> None:
    # Within the box, so that loose vertices do not change it.
    largest = float(np.abs(mesh.vertices).max())
    if largest > LARGEST_NUMBER:
        raise MeshError(
            f"The mesh has coordinates of {largest:.0e}, too large to be computed with; scale the mesh down."
        )
    if not mesh.areas.sum() > SMALLEST_AREA:
        raise MeshError("The faces of the mesh have no area; check the scale of the object and merged vertices.")


def connected_pieces(left: Ints, right: Ints, n: int) -> Ints:
    """Return (n,) the piece of each of n things that hang together in pairs, left with right; numbered from 0."""
    graph = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n, n))
    return connected_components(graph, directed=False)[1]


def area_vectors(corners: Floats) -> Floats:
    """Return (T, 3) normals of triangles (T, 3, 3), as long as twice their areas."""
    a, b, c = corners.swapaxes(0, 1)
    return np.cross(b - a, c - a)


def unit_rows(rows: Floats) -> Floats:
    """Return rows of length 1; zeros stay."""
    return rows / np.maximum(np.linalg.norm(rows, axis=-1, keepdims=True), np.finfo(float).tiny)


def vertex_normals(triangles: Ints, vectors: Floats, n_vertices: int) -> Floats:
    """Return (V, 3) unit normals: the direction of the sum of the area vectors (T, 3) around each vertex."""
    around = np.repeat(vectors, 3, axis=0)
    sums = [np.bincount(triangles.ravel(), column, n_vertices) for column in around.T]
    return unit_rows(np.stack(sums, axis=1))


def sum_by(index: Ints, weight: Floats, size: int = 0) -> Floats:
    """Return the sum of the weights at each index, of at least the given size."""
    return np.asarray(np.bincount(index, weight, size), dtype=np.float64)
