"""The link of every vertex of a triangle net, as tables that are read all at once."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.csgraph import connected_components

from ..mesh import Bools, Ints, edges_of


@dataclass(frozen=True, eq=False)
class Links:
    """The triangles of a net sorted by corner: a row for each corner of each triangle.

    Row r says that the triangle (``corner[r]``, ``ahead[r]``, ``behind[r]``) has this corner; (``ahead``, ``behind``)
    is then an edge of the corner's link. Rows of one vertex are contiguous.

    Attributes
    ----------
    triangles : (m, 3) int64
    n_vertices : int
        Vertices of the net, those in no triangle included.
    vertex : (u,) int64
        The vertices that have triangles, ascending.
    start : (u,) int64
        First row of each of them.
    corner, ahead, behind : (3 m,) int64
    """

    triangles: Ints
    n_vertices: int
    vertex: Ints
    start: Ints
    corner: Ints
    ahead: Ints
    behind: Ints

    @cached_property
    def is_plain(self) -> Bools:
        """(n_vertices,) whether the link is a single closed cycle: an inner vertex of a manifold."""
        edges = edges_of(self.triangles, self.n_vertices)
        plain = np.zeros(self.n_vertices, dtype=bool)
        plain[self.vertex] = True
        plain[edges.vertices[edges.n_triangles != 2]] = False
        plain[self._pinched(edges.neighbours, edges.vertices[edges.shared])] = False
        return plain

    def _pinched(self, neighbours: Ints, ends: Ints) -> Ints:
        """Return vertices whose triangles hang together in several fans."""
        # One node for each corner of each triangle; corners at the same vertex are joined across shared edges.
        left, right = (_corner_number(self.triangles, neighbours[:, side], ends) for side in (0, 1))
        n_corners = self.triangles.size
        graph = coo_array((np.ones(left.size, dtype=bool), (left, right)), shape=(n_corners, n_corners))
        _, fan = connected_components(graph, directed=False)
        first_of_fan = np.unique(fan, return_index=True)[1]
        n_fans = np.bincount(self.triangles.ravel()[first_of_fan], minlength=self.n_vertices)
        return np.flatnonzero(n_fans > 1)


def _corner_number(triangles: Ints, triangle: Ints, ends: Ints) -> Ints:
    """Return 3 t + k for both end points of an edge of each given triangle."""
    corners = triangles[triangle]
    local = [(corners == ends[:, side, None]).argmax(axis=1) for side in (0, 1)]
    return np.concatenate([3 * triangle + k for k in local])


def links_of(triangles: Ints, n_vertices: int) -> Links:
    """Return the links of a net with ``n_vertices`` vertices."""
    n_corners = triangles.size
    # A sparse transposition is a counting sort of the corners by vertex, several times faster than sorting them.
    by_triangle = csc_array(
        (np.arange(n_corners), triangles.ravel(), np.arange(0, n_corners + 1, 3)), shape=(n_vertices, len(triangles))
    )
    by_vertex = by_triangle.tocsr()
    rows = by_vertex.data
    n_rows = np.diff(by_vertex.indptr)
    vertex = np.flatnonzero(n_rows)
    start = by_vertex.indptr[:-1][vertex].astype(np.int64)
    corner, ahead, behind = (np.roll(triangles, -shift, axis=1).ravel()[rows] for shift in (0, 1, 2))
    return Links(triangles, n_vertices, vertex, start, corner, ahead, behind)
