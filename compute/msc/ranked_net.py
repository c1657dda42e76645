"""A triangle net with a strict order of its vertices: what critical points and merge trees are found on."""

from dataclasses import dataclass, replace

import numpy as np

from ..surface.mesh import Floats, Ints
from .links import Links


@dataclass(frozen=True, eq=False)
class RankedNet:
    """A net of n vertices and m triangles, swept upwards over a strict order of the vertices.

    Attributes
    ----------
    links : Links
    rank : (n,) int64
        The place of each vertex in the order.
    candidates : (c,) int64
        The vertices that are perhaps critical: all but those whose closed link changes side just twice. They are the
        same for both directions of the sweep.
    """

    links: Links
    rank: Ints
    candidates: Ints

    @property
    def n_vertices(self) -> int:
        """Vertices of the net, those in no triangle included."""
        return self.links.n_vertices

    @property
    def vertex_at_rank(self) -> Ints:
        """(n,) the vertex at each rank."""
        return _inverse(self.rank)

    @property
    def corners(self) -> tuple[Ints, Ints, Ints]:
        """(m,) the ranks of the lowest, middle and highest corner of every triangle."""
        return _ranked_corners(self.rank, self.links)

    def reversed(self) -> "RankedNet":
        """Return the net in the opposite order, in which the superlevel sets are swept."""
        return replace(self, rank=self.n_vertices - 1 - self.rank)


def ranked_net(links: Links, values: Floats) -> RankedNet:
    """Order the vertices of a net by the values (n,) of a field; equal values are ordered by index."""
    rank = _rank_of(values)
    return RankedNet(links, rank, _perhaps_critical(rank, links))


def _rank_of(values: Floats) -> Ints:
    order = np.argsort(values)
    rising = values[order]
    # A stable sort takes several times as long, and is needed for equal values only.
    if (rising[1:] == rising[:-1]).any():
        order = np.argsort(values, kind="stable")
    return _inverse(order)


def _inverse(order: Ints) -> Ints:
    inverse = np.empty(len(order), dtype=np.int64)
    inverse[order] = np.arange(len(order))
    return inverse


def _ranked_corners(rank: Ints, links: Links) -> tuple[Ints, Ints, Ints]:
    first, second, third = rank[links.triangles.T]
    low, high = np.minimum(first, second), np.maximum(first, second)
    middle = np.minimum(high, third)
    return np.minimum(low, middle), np.maximum(low, middle), np.maximum(high, third)


def _perhaps_critical(rank: Ints, links: Links) -> Ints:
    _, middle, _ = _ranked_corners(rank, links)
    # A link edge changes side where its triangle has the vertex as its middle corner.
    n_changes = np.bincount(middle, minlength=links.n_vertices)[rank]
    return np.flatnonzero(((n_changes != 2) | ~links.is_plain) & (links.n_triangles > 0))
