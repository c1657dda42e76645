"""The links of the vertices of a triangle net: where a vertex has an ordinary neighbourhood and where it has not."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..surface.mesh import Bools, Edges, Ints, edges_of, sorted_sides

# Vertices in more triangles than this are not walked around but count as not plain, which is slower and as exact.
LONGEST_WALK = 64


@dataclass(frozen=True, eq=False)
class Links:
    """A triangle net as a complex; the link of a vertex is made of the edges opposite to it in its triangles.

    Attributes
    ----------
    triangles : (m, 3) int64
    n_vertices : int
        Vertices of the net, those in no triangle included.
    """

    triangles: Ints
    n_vertices: int

    @cached_property
    def edges(self) -> Edges:
        """The edges of the net."""
        return edges_of(self.triangles, self.n_vertices)

    @cached_property
    def n_triangles(self) -> Ints:
        """(n_vertices,) how many triangles meet at each vertex."""
        return np.bincount(self.triangles.ravel(), minlength=self.n_vertices)

    @cached_property
    def vertex(self) -> Ints:
        """The vertices that are in triangles, ascending."""
        return np.flatnonzero(self.n_triangles)

    @cached_property
    def opposite(self) -> Ints:
        """(3 m,) the other side of the edge from corner k to k + 1 of triangle t, at 3 t + k.

        It is -1 where the edge has not exactly two triangles.
        """
        order, _, is_new = sorted_sides(self.triangles, self.n_vertices)
        first = np.flatnonzero(is_new)
        pairs = first[np.diff(np.append(first, len(order))) == 2]
        opposite = np.full(len(order), -1)
        opposite[order[pairs]] = order[pairs + 1]
        opposite[order[pairs + 1]] = order[pairs]
        return opposite

    @cached_property
    def turn(self) -> Ints:
        """(3 m,) the corner that is next around the same vertex; -1 at a boundary and where the winding changes."""
        corner = self.triangles.ravel()
        following = np.arange(len(corner)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
        across = following[self.opposite]
        return np.where((self.opposite >= 0) & (corner[across] == corner), across, -1)

    @cached_property
    def is_plain(self) -> Bools:
        """(n_vertices,) whether the link is known to be a single closed cycle: an inner vertex of a manifold."""
        corner = self.triangles.ravel()
        first = np.full(self.n_vertices, -1)
        first[corner] = np.arange(len(corner))
        plain = np.zeros(self.n_vertices, dtype=bool)
        walking, at = self.vertex, first[self.vertex]
        for n_steps in range(1, LONGEST_WALK + 1):
            at = self.turn[at]
            is_back = at == first[walking]
            plain[walking[is_back]] = self.n_triangles[walking[is_back]] == n_steps
            goes_on = (at >= 0) & ~is_back
            walking, at = walking[goes_on], at[goes_on]
        return plain


def links_of(triangles: Ints, n_vertices: int) -> Links:
    """Return the links of a net with ``n_vertices`` vertices."""
    return Links(triangles, n_vertices)
