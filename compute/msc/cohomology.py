"""The loops of a net up to deformation: Betti numbers, and a basis of the 1-cocycles that tells loops apart.

A 1-cocycle with coefficients 0 and 1 marks edges such that every triangle has an even number of marked ones. A closed
path bounds a piece of the net if and only if it crosses every cocycle of a basis an even number of times.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from ..surface.mesh import Bools, Edges, Ints, connected_pieces
from .links import Links


@dataclass(frozen=True, eq=False)
class Cocycles:
    """A basis of the first cohomology of a net with coefficients modulo 2.

    Attributes
    ----------
    betti : tuple of int
        Components, independent loops, enclosed volumes.
    edge, cocycle : (r,) int64
        Edge ``edge[r]`` is marked in cocycle ``cocycle[r]``; a pair occurs once.
    edges : Edges
        Of the net.
    n_vertices : int
    """

    betti: tuple[int, int, int]
    edge: Ints
    cocycle: Ints
    edges: Edges
    n_vertices: int

    def along(self, start: Ints, stop: Ints) -> NDArray[np.uint64]:
        """(k, w) the cocycles of each net edge, given by its two ends, as bits of 64 a word; none for equal ends."""
        wanted = np.minimum(start, stop) * self.n_vertices + np.maximum(start, stop)
        keys, bits = self._marked
        place = np.minimum(keys.searchsorted(wanted), len(keys) - 1)
        return np.where((keys[place] == wanted)[:, None], bits[place], np.uint64(0))

    @cached_property
    def _marked(self) -> tuple[Ints, NDArray[np.uint64]]:
        """Return the marked edges as sorted keys, and the bits of each; a last row stands for no edge."""
        edge, row = np.unique(self.edge, return_inverse=True)
        bits = np.zeros((len(edge) + 1, self.betti[1] // 64 + 1), dtype=np.uint64)
        word, place = np.divmod(self.cocycle, 64)
        np.bitwise_or.at(bits, (row.reshape(-1), word), np.left_shift(np.uint64(1), place.astype(np.uint64)))
        low, high = self.edges.vertices[edge].T
        return np.append(low * self.n_vertices + high, np.iinfo(np.int64).max), bits


def cocycles_of(links: Links) -> Cocycles:
    """Return a basis of the 1-cocycles of a net, by a spanning tree of its vertices and one of its triangles.

    An edge in neither tree closes one loop of triangles, and the edges which that loop crosses form a cocycle
    (Eppstein's tree-cotree decomposition). Where three or more triangles meet at an edge, a cocycle that contains it
    spreads into all of them, and exists if it can end in every closed sheet; that is a small linear system.
    """
    edges, n_triangles = links.edges, len(links.triangles)
    in_tree, n_components = _vertex_tree(links)
    cotree = _triangle_tree(edges, n_triangles, in_tree)
    in_cotree = np.zeros(len(in_tree), dtype=bool)
    in_cotree[cotree.edge_to_parent[cotree.edge_to_parent >= 0]] = True
    generators = np.flatnonzero(~in_tree & ~in_cotree)
    edge, generator, end = _spread(edges, generators, cotree)
    combinations, n_independent = _balanced_combinations(edges, generators, end, cotree)
    edge, cocycle = _combined(edge, generator, combinations)
    betti = (n_components, len(combinations), cotree.n_closed - n_independent)
    return Cocycles(betti=betti, edge=edge, cocycle=cocycle, edges=edges, n_vertices=links.n_vertices)


@dataclass(frozen=True, eq=False)
class _Cotree:
    """Triangles as a forest, T + 2 nodes: behind the triangles the outside of the boundary and the common root."""

    parent: Ints
    edge_to_parent: Ints
    is_closed_root: Bools

    @property
    def n_closed(self) -> int:
        """Sheets without boundary."""
        return int(self.is_closed_root.sum())


def _vertex_tree(links: Links) -> tuple[Bools, int]:
    """Return the mask of the edges that are in a spanning forest, and the number of its trees."""
    ends, n = links.edges.vertices.astype(np.int32), links.n_vertices
    # Each edge's number is its weight, so that the result says which edges were taken.
    numbers = np.arange(1, len(ends) + 1, dtype=np.float64)
    tree = minimum_spanning_tree(coo_array((numbers, (ends[:, 0], ends[:, 1])), shape=(n, n)).tocsr())
    in_tree = np.zeros(len(ends), dtype=bool)
    in_tree[tree.data.astype(np.int64) - 1] = True
    return in_tree, len(links.vertex) - int(in_tree.sum())


def _triangle_tree(edges: Edges, n_triangles: int, in_tree: Bools) -> _Cotree:
    """Return a spanning forest of the triangles that crosses only edges outside the vertex tree."""
    outside, root = n_triangles, n_triangles + 1
    edge, left, right = _crossings(edges, in_tree, outside)
    sheet = connected_pieces(left, right, root)
    first = np.unique(sheet, return_index=True)[1]
    first[sheet[outside]] = outside
    joined = coo_array(
        (np.ones(len(left) + len(first)), (np.append(left, first), np.append(right, np.full(len(first), root)))),
        shape=(root + 1, root + 1),
    )
    _, parent = breadth_first_order(joined.tocsr(), root, directed=False)
    edge_to_parent = np.full(root + 1, -1)
    goes_left = parent[right] == left
    edge_to_parent[right[goes_left]] = edge[goes_left]
    goes_right = parent[left] == right
    edge_to_parent[left[goes_right]] = edge[goes_right]
    is_closed_root = np.zeros(root + 1, dtype=bool)
    is_closed_root[first] = True
    is_closed_root[outside] = False
    return _Cotree(parent.astype(np.int64), edge_to_parent, is_closed_root)


def _crossings(edges: Edges, in_tree: Bools, outside: int) -> tuple[Ints, Ints, Ints]:
    """Return the edges that can be crossed and what lies on both sides of each."""
    inner = ~in_tree[edges.shared] & (edges.n_triangles[edges.shared] == 2)
    left, right = edges.neighbours[inner].T
    rim = ~in_tree & (edges.n_triangles == 1)
    triangle, place = np.nonzero(rim[edges.of_triangle])
    edge = np.append(edges.shared[inner], edges.of_triangle[triangle, place])
    return edge, np.append(left, triangle), np.append(right, np.full(len(triangle), outside))


def _spread(edges: Edges, generators: Ints, cotree: _Cotree) -> tuple[Ints, Ints, Ints]:
    """Follow each generator from the triangles at its edge to the roots.

    Returns the crossed edges with the numbers of their generators, the generators' own edges included, and the root
    and generator of each path as rows of ``end``.
    """
    number = np.full(len(edges.n_triangles), -1)
    number[generators] = np.arange(len(generators))
    triangle, place = np.nonzero(number[edges.of_triangle] >= 0)
    generator = number[edges.of_triangle[triangle, place]]
    crossed, by = [generators], [np.arange(len(generators))]
    at, ends = triangle, []
    while len(at):
        edge = cotree.edge_to_parent[at]
        stops = edge < 0
        ends.append(np.stack([at[stops], generator[stops]]))
        at, generator, edge = at[~stops], generator[~stops], edge[~stops]
        crossed.append(edge)
        by.append(generator)
        at = cotree.parent[at]
    return (
        np.concatenate(crossed),
        np.concatenate(by),
        np.concatenate([*ends, np.empty((2, 0), dtype=np.int64)], axis=1),
    )


def _balanced_combinations(edges: Edges, generators: Ints, end: Ints, cotree: _Cotree) -> tuple[list[list[int]], int]:
    """Return the independent sets of generators whose paths end evenly in every closed sheet, and the rank."""
    n_sheets = edges.n_triangles[generators]
    free = np.flatnonzero(n_sheets <= 2)
    bound = np.flatnonzero(n_sheets > 2)
    odd_ends = {generator: 0 for generator in bound.tolist()}
    root, generator = end
    counts = cotree.is_closed_root[root] & (n_sheets[generator] > 2)
    for sheet, number in zip(root[counts].tolist(), generator[counts].tolist(), strict=True):
        odd_ends[number] ^= 1 << sheet
    combinations = [[number] for number in free.tolist()]
    echelon: dict[int, tuple[int, int]] = {}
    for number, vector in odd_ends.items():
        rest, taken = reduce_vector(vector, 1 << number, echelon)
        if rest:
            echelon[rest.bit_length()] = rest, taken
        else:
            combinations.append([place for place in range(taken.bit_length()) if taken >> place & 1])
    return combinations, len(echelon)


def reduce_vector(vector: int, taken: int, echelon: dict[int, tuple[int, int]]) -> tuple[int, int]:
    """Eliminate a vector modulo 2, the bits of an integer, by an echelon of (vector, history) by leading bit."""
    while vector and (pivot := echelon.get(vector.bit_length())):
        vector, taken = vector ^ pivot[0], taken ^ pivot[1]
    return vector, taken


def _combined(edge: Ints, generator: Ints, combinations: list[list[int]]) -> tuple[Ints, Ints]:
    """Return the marked edges of every combination of generators; what is marked twice is not."""
    order = np.argsort(generator, kind="stable")
    edge, starts = edge[order], np.searchsorted(generator[order], np.arange(generator.max(initial=-1) + 2))
    marked = []
    for combination in combinations:
        edges, count = np.unique(
            np.concatenate([edge[starts[number] : starts[number + 1]] for number in combination]), return_counts=True
        )
        marked.append(edges[count % 2 == 1])
    cocycle = np.repeat(np.arange(len(marked)), [len(edges) for edges in marked])
    return np.concatenate([*marked, np.empty(0, dtype=np.int64)]), cocycle
