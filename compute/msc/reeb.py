"""The Reeb graph of the level sets of a field: their components appear, split, merge and vanish at its nodes."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import LevelError
from ..surface.mesh import Bools, Floats, Ints
from .ranked_net import RankedNet

# Pieces of triangles between critical levels that are laid out at once; noise with all its features has far more.
MOST_PIECES = 50_000_000


@dataclass(frozen=True, eq=False)
class ReebGraph:
    """Arcs between critical points; A arcs, N nodes.

    Attributes
    ----------
    vertex : (N,) int64
        Net vertex of each node, rising.
    arcs : (A, 2) int64
        The lower and the upper node of each arc.
    arc_of_triangle : (m,) int64
        The arc that the middle level of each net triangle lies on.
    arc_of_vertex : (n,) int64
        The arc of each net vertex; -1 for nodes and for vertices in no triangle.

    Examples
    --------
    >>> graph = reeb_graph(analysis)
    >>> graph.n_components
    1
    """

    vertex: Ints
    arcs: Ints
    arc_of_triangle: Ints
    arc_of_vertex: Ints

    @property
    def n_loops(self) -> int:
        """Independent loops; the genus of a closed orientable surface."""
        return len(self.arcs) - len(self.vertex) + self.n_components

    @property
    def n_components(self) -> int:
        """Pieces that the graph is in."""
        return _n_components(len(self.vertex), self.arcs[:, 0], self.arcs[:, 1])

    @cached_property
    def degree(self) -> Ints:
        """(N,) arcs at each node: 1 at extrema, 3 and more where level sets split or merge."""
        return np.bincount(self.arcs.ravel(), minlength=len(self.vertex))


def build_reeb_graph(values: Floats, net: RankedNet, critical: Ints) -> ReebGraph:
    """Return the Reeb graph with the given critical points; others are passed over as if the field rose there.

    The levels of the critical points cut every triangle into slices. Slices between the same two levels are joined
    across edges. At a level, what does not hang together with its critical point goes straight on; the rest ends at
    the node.

    Parameters
    ----------
    values : (n,) float64
    net : RankedNet
        Ordered by the values.
    critical : (N,) int64
        The lowest and highest vertex of each component, and pairs and handles in whole.

    Raises
    ------
    LevelError
        If the critical points are so many that the slices would not fit into memory.
    """
    nodes = critical[np.argsort(net.rank[critical])]
    slices = _Slices.of(net, net.rank[nodes])
    inside = _levels_along_edges(net, slices)
    contacts, passing = _level_sets(net, slices, inside)
    left, right = _touching_slices(net, slices, inside)
    _, piece = _components(slices.count, np.concatenate([left, passing[0]]), np.concatenate([right, passing[1]]))
    arcs = _Chains.of(contacts[0], piece[contacts[1]], len(nodes))
    triangles = net.links.triangles
    middle = np.searchsorted(values[nodes], values[triangles.T].mean(axis=0), side="right") - 1
    middle = np.clip(middle, slices.first, slices.last)
    rows = slices.at(np.arange(len(triangles)), middle)
    return ReebGraph(
        vertex=nodes,
        arcs=arcs.ends,
        arc_of_triangle=arcs.at(piece[rows], middle),
        arc_of_vertex=_arc_of_vertex(net, slices, piece, arcs),
    )


@dataclass(frozen=True, eq=False)
class _Chains:
    """The arcs of connected pieces of slices, from node to node.

    Where noise was passed over, a piece can touch a node in its middle: the arc is divided there. And a piece that
    touches a single node is noise at that node: it counts to another arc there.

    Attributes
    ----------
    keys : (r,) int64
        Piece times the number of nodes plus node, for all that touch, ascending.
    instead : (P,) int64
        The piece that stands for each piece: itself unless it touches a single node.
    n_nodes : int
    """

    keys: Ints
    instead: Ints
    n_nodes: int

    @classmethod
    def of(cls, node: Ints, piece: Ints, n_nodes: int) -> "_Chains":
        keys = np.unique(piece * n_nodes + node)
        piece, node = np.divmod(keys, n_nodes)
        touches = np.bincount(piece)
        proper = touches[piece] > 1
        at_node = np.full(n_nodes, -1)
        at_node[node[proper]] = piece[proper]
        instead = np.arange(len(touches))
        instead[piece[~proper]] = at_node[node[~proper]]
        return cls(keys[proper], instead, n_nodes)

    @cached_property
    def ends(self) -> Ints:
        """(A, 2) the lower and upper node of each arc."""
        return np.stack([self.keys[:-1], self.keys[1:]], axis=1)[self._is_arc] % self.n_nodes

    def at(self, piece: Ints, level: Ints) -> Ints:
        """Return the arc of slices, given by their pieces and the levels they lie above."""
        piece = self.instead[piece]
        row = self.keys.searchsorted(piece * self.n_nodes + level, side="right") - 1
        lowest, highest = self._first_key[piece], self._first_key[piece + 1] - 2
        return self._arc_of_key[np.clip(row, lowest, highest)]

    @cached_property
    def _first_key(self) -> Ints:
        """(P + 1,) where the keys of each piece begin."""
        return self.keys.searchsorted(np.arange(len(self.instead) + 1) * self.n_nodes)

    @cached_property
    def _arc_of_key(self) -> Ints:
        return np.cumsum(self._is_arc) - 1

    @cached_property
    def _is_arc(self) -> Bools:
        piece = self.keys // self.n_nodes
        return piece[1:] == piece[:-1]


@dataclass(frozen=True, eq=False)
class _Slices:
    """The slices of all triangles; slice j of a triangle lies between the levels j and j + 1."""

    levels: Ints
    first: Ints
    last: Ints
    offset: Ints

    @classmethod
    def of(cls, net: RankedNet, levels: Ints) -> "_Slices":
        low, _, high = net.corners
        first = np.searchsorted(levels, low, side="right") - 1
        last = np.searchsorted(levels, high, side="left") - 1
        ends = np.cumsum(last - first + 1)
        if len(ends) and ends[-1] > MOST_PIECES:
            raise LevelError(
                f"The Reeb graph of {len(levels)} critical points is too large to be built; choose a lower level."
            )
        return cls(levels, first, last, np.append(0, ends))

    @property
    def count(self) -> int:
        return int(self.offset[-1])

    def at(self, triangle: Ints, place: Ints) -> Ints:
        """Return the numbers of slices."""
        return self.offset[triangle] + place - self.first[triangle]


def _runs(start: Ints, stop: Ints) -> tuple[Ints, Ints]:
    """Return (row, number) for every number from ``start[row]`` to ``stop[row]``, both included."""
    length = np.maximum(stop - start + 1, 0)
    row = np.repeat(np.arange(len(start)), length)
    return row, np.arange(len(row)) - np.repeat(np.cumsum(length) - length, length) + start[row]


def _touching_slices(net: RankedNet, slices: _Slices, inside: tuple[Ints, Ints]) -> tuple[Ints, Ints]:
    """Return pairs of slices between the same levels that share a stretch of an edge, or a pinched vertex."""
    first, last = inside
    row, place = _runs(first - 1, last)
    left, right = net.links.edges.neighbours[row].T
    pinched = ~net.links.is_plain
    pinched[_node_at_rank(net, slices)[net.rank] >= 0] = False
    triangle, corner = np.nonzero(pinched[net.links.triangles])
    vertex = net.links.triangles[triangle, corner]
    order = np.argsort(vertex, kind="stable")
    triangle, vertex = triangle[order], vertex[order]
    around = slices.at(triangle, np.searchsorted(slices.levels, net.rank[vertex]) - 1)
    same = vertex[1:] == vertex[:-1]
    return (
        np.append(slices.at(left, place), around[:-1][same]),
        np.append(slices.at(right, place), around[1:][same]),
    )


def _levels_along_edges(net: RankedNet, slices: _Slices) -> tuple[Ints, Ints]:
    """Return the first and last level strictly inside each shared edge, one row for each pair of neighbours."""
    left, right = net.rank[net.links.edges.vertices.T]
    first = np.searchsorted(slices.levels, np.minimum(left, right), side="right")
    last = np.searchsorted(slices.levels, np.maximum(left, right), side="left") - 1
    return first[net.links.edges.shared], last[net.links.edges.shared]


def _level_sets(net: RankedNet, slices: _Slices, inside: tuple[Ints, Ints]) -> tuple[Ints, tuple[Ints, Ints]]:
    """Follow the level sets of the critical points.

    Returns the rows (node, slice) of what touches the level set component of a node, and the pairs of slices below and
    above a level in the triangles where it passes by its node.
    """
    triangle, level = _runs(slices.first + 1, slices.last)
    n_before = slices.offset[:-1] - np.arange(len(net.links.triangles))
    n_nodes, n_cuts = len(slices.levels), len(triangle)

    def cut(of_triangle: Ints, of_level: Ints) -> Ints:
        return n_nodes + n_before[of_triangle] + of_level - slices.first[of_triangle] - 1

    row, level_of_row = _runs(*inside)
    left, right = net.links.edges.neighbours[row].T
    touching, node, is_low, is_high = _triangles_of_nodes(net, slices)
    through = ~is_low & ~is_high
    _, component = _components(
        n_nodes + n_cuts,
        np.append(cut(left, level_of_row), cut(touching[through], node[through])),
        np.append(cut(right, level_of_row), node[through]),
    )
    has_node = component[n_nodes:] == component[:n_nodes][level]
    below, above = slices.at(triangle, level - 1), slices.at(triangle, level)
    contacts = [
        np.stack([level[has_node], below[has_node]]),
        np.stack([level[has_node], above[has_node]]),
        np.stack([node[is_low], slices.at(touching, node)[is_low]]),
        np.stack([node[is_high], slices.at(touching, node - 1)[is_high]]),
    ]
    return np.concatenate(contacts, axis=1), (below[~has_node], above[~has_node])


def _triangles_of_nodes(net: RankedNet, slices: _Slices) -> tuple[Ints, Ints, Bools, Bools]:
    """Return the triangles at each node, and whether the node is their lowest or highest corner."""
    node = _node_at_rank(net, slices)[net.rank][net.links.triangles]
    triangle, corner = np.nonzero(node >= 0)
    low, _, high = net.corners
    node = node[triangle, corner]
    height = slices.levels[node]
    return triangle, node, height == low[triangle], height == high[triangle]


def _node_at_rank(net: RankedNet, slices: _Slices) -> Ints:
    """Return (n,) the node of each rank, -1 for ranks of other vertices."""
    node = np.full(net.n_vertices, -1)
    node[slices.levels] = np.arange(len(slices.levels))
    return node


def _arc_of_vertex(net: RankedNet, slices: _Slices, piece: Ints, arcs: _Chains) -> Ints:
    # Any triangle at a vertex will do: around it, slices between the same levels are joined.
    triangle = np.full(net.n_vertices, -1)
    triangle[net.links.triangles.ravel()] = np.repeat(np.arange(len(net.links.triangles)), 3)
    vertex = np.flatnonzero((triangle >= 0) & (_node_at_rank(net, slices)[net.rank] < 0))
    level = np.searchsorted(slices.levels, net.rank[vertex]) - 1
    arc = np.full(net.n_vertices, -1)
    arc[vertex] = arcs.at(piece[slices.at(triangle[vertex], level)], level)
    return arc


def _components(n: int, left: Ints, right: Ints) -> tuple[int, Ints]:
    graph = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n, n))
    count, component = connected_components(graph, directed=False)
    return int(count), component


def _n_components(n: int, left: Ints, right: Ints) -> int:
    return _components(n, left, right)[0]
