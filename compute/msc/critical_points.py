"""Critical points of a piecewise linear function, by the index of the lower link."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from ..surface.mesh import Bools, Floats, Ints, connected_pieces
from .ranked_net import RankedNet


class Kind(IntEnum):
    """Kinds of critical points, by the change of the sublevel set."""

    MINIMUM = 0
    SADDLE = 1
    MAXIMUM = 2


@dataclass(frozen=True, eq=False)
class CriticalPoints:
    """Critical points, one row for each vertex and kind.

    Let the lower link of a vertex have c components and b independent cycles. It is a minimum if c = 0, a saddle of
    multiplicity c - 1 if c > 1, and a maximum of multiplicity b if b > 0. With boundary a local maximum need not be
    one: on a square, cos(pi x) has its largest values on a side, where the sublevel set does not change its topology.

    Attributes
    ----------
    vertex : (c,) int64
        Vertex of the net.
    kind : (c,) int64
        A :class:`Kind`.
    multiplicity : (c,) int64
    value : (c,) float64
    """

    vertex: Ints
    kind: Ints
    multiplicity: Ints
    value: Floats

    @property
    def euler_characteristic(self) -> int:
        """Minima - saddles + maxima with multiplicity, which is the Euler characteristic of the net."""
        return int(((-1) ** self.kind * self.multiplicity).sum())

    def unfolded(self) -> "CriticalPoints":
        """Return simple points only: a k-fold saddle as k saddles at the same vertex."""
        rows = np.repeat(np.arange(len(self.vertex)), self.multiplicity)
        return CriticalPoints(self.vertex[rows], self.kind[rows], np.ones_like(rows), self.value[rows])


@dataclass(frozen=True, eq=False)
class Sectors:
    """The components of the lower links of some vertices.

    Attributes
    ----------
    vertex : (s,) int64
        A vertex, repeated for each component of its lower link; ascending in rank.
    lowest : (s,) int64
        The lowest vertex of that component.
    """

    vertex: Ints
    lowest: Ints


def critical_points(values: Floats, net: RankedNet) -> CriticalPoints:
    """Classify every vertex of the net.

    Parameters
    ----------
    values : (n,) float64
    net : RankedNet
        Ordered by the values.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.2; the index on complexes that are no closed manifolds is the method page's.
    """
    candidates = net.candidates
    nodes, n_link_edges = _lower_link(candidates, net)
    n_nodes = np.bincount(nodes.vertex, minlength=net.n_vertices)[candidates]
    n_components = np.bincount(nodes.vertex[nodes.is_first], minlength=net.n_vertices)[candidates]
    n_cycles = n_link_edges[candidates] - n_nodes + n_components
    multiplicity = np.stack([n_components == 0, np.maximum(n_components - 1, 0), n_cycles], axis=1).astype(np.int64)
    row, kind = np.nonzero(multiplicity)
    vertex = candidates[row]
    return CriticalPoints(vertex, kind, multiplicity[row, kind], values[vertex])


def merging_sectors(net: RankedNet) -> Sectors:
    """Return the lower-link components of those vertices that have two or more, in the order of a rising sweep."""
    nodes, _ = _lower_link(net.candidates, net)
    vertex, lowest = nodes.vertex[nodes.is_first], nodes.neighbour[nodes.is_first]
    merges = np.bincount(vertex, minlength=net.n_vertices)[vertex] > 1
    order = np.argsort(net.rank[vertex[merges]], kind="stable")
    return Sectors(vertex[merges][order], lowest[merges][order])


def sector_nodes(vertices: Ints, net: RankedNet) -> tuple[Ints, Ints, Ints]:
    """Return the lower neighbours of some vertices, as rows (vertex, neighbour, number of the sector)."""
    nodes, _ = _lower_link(vertices, net)
    return nodes.vertex, nodes.neighbour, nodes.component


@dataclass(frozen=True, eq=False)
class _LinkNodes:
    """Vertices of lower links with the component of each; the lowest one of a component is marked ``is_first``."""

    vertex: Ints
    neighbour: Ints
    component: Ints
    is_first: Bools


def _lower_link(vertices: Ints, net: RankedNet) -> tuple[_LinkNodes, Ints]:
    """Return the nodes of the lower links with their components, and the number of link edges by vertex."""
    n, rank, triangles = net.n_vertices, net.rank, net.links.triangles
    wanted = np.zeros(n, dtype=bool)
    wanted[vertices] = True
    triangle, place = np.nonzero(wanted[triangles])
    corner, ahead, behind = (triangles[triangle, (place + shift) % 3] for shift in range(3))
    low_ahead, low_behind = rank[ahead] < rank[corner], rank[behind] < rank[corner]
    # A node is a pair (vertex, lower neighbour); its key sorts by vertex, then by height.
    key_ahead, key_behind = corner * n + rank[ahead], corner * n + rank[behind]
    keys = np.unique(np.concatenate([key_ahead[low_ahead], key_behind[low_behind]]))
    is_edge = low_ahead & low_behind
    ends = keys.searchsorted(key_ahead[is_edge]), keys.searchsorted(key_behind[is_edge])
    component = connected_pieces(*ends, len(keys))
    is_first = np.zeros(len(keys), dtype=bool)
    is_first[np.unique(component, return_index=True)[1]] = True
    nodes = _LinkNodes(keys // n, net.vertex_at_rank[keys % n], component, is_first)
    return nodes, np.bincount(corner[is_edge], minlength=n)
