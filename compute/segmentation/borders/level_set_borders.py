"""Borders of parts: where their level sets cross the edges of the input."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, depth_first_order

from ...surface.mesh import Bools, Floats, Ints, TriangleMesh
from ..hierarchy.arc_tree import NO_ARC, ArcTree
from .edge_profile import EdgeProfile

# A border that crosses an edge nearer to its end than this fraction of it goes through the vertex: no slivers.
SNAP = 0.05


@dataclass(frozen=True, eq=False)
class Crossings:
    """Crossings of borders and edges, one row each, sorted by edge and along it.

    Attributes
    ----------
    edge : (n,) int64
    parameter : (n,) float64
        From 0 at the first vertex of the edge to 1 at the second.
    is_entry : (n,) bool
        Whether the edge enters the part there, from the first vertex to the second; it leaves it otherwise.
    border : (n,) int64
        Which border it is; a border is the closed or open line around one cut-off part of one tree.
    arcs : (n, trees) int64
        The arcs behind the crossing, for each tree: what lies there as far as the next crossing or the vertex.
    """

    edge: Ints
    parameter: Floats
    is_entry: Bools
    border: Ints
    arcs: Ints

    def snapped(self, margin: float = SNAP) -> Floats:
        """Return the parameters, moved to 0 or 1 where they are nearer to it than a margin."""
        return np.where(self.parameter < margin, 0.0, np.where(self.parameter > 1 - margin, 1.0, self.parameter))


@dataclass(frozen=True, eq=False)
class Polyline:
    """One line of the border of a part.

    Attributes
    ----------
    part : int
        The part it cuts off.
    points : (n, 3) float64
        On edges of the input; the last point of a closed line is not repeated.
    is_closed : bool
    """

    part: int
    points: Floats
    is_closed: bool


def closing_heights(values: Floats, tree: ArcTree) -> Floats:
    """Return (A,) the value of the field at which each arc closes; not a number for the root and whole shells."""
    return np.where(tree.has_saddle, values[tree.saddle], np.nan)


def cross_edges(
    profile: EdgeProfile, trees: tuple[ArcTree, ...], heights: tuple[Floats, ...], cuts: list[Ints]
) -> Crossings:
    """Find where the borders of parts cross edges.

    A vertex lies in a part if its arc does, so every border is a set of lines around vertices: it crosses the edges
    that leave the part, each once, where the field first falls to the level of the saddle.

    Parameters
    ----------
    profile : EdgeProfile
    trees : tuple of ArcTree
    heights : tuple of (A,) float64
        For each tree, the level at which each arc closes.
    cuts : list of (A,) int64
        For each tree, the part that is cut off at each arc, 0 where nothing is.
    """
    passages = [_passages(profile, number, tree, heights[number], cuts[number]) for number, tree in enumerate(trees)]
    columns = ("edge", "parameter", "arc", "behind", "is_entry")
    edge, parameter, arc, behind, is_entry = (
        np.concatenate([getattr(passage, column) for passage in passages]) for column in columns
    )
    of_tree = np.repeat(np.arange(len(trees)), [len(passage.edge) for passage in passages])
    # Numerical noise aside, everything that an edge leaves lies before everything that it enters.
    order = np.lexsort((parameter, is_entry, edge))
    edge, of_tree = edge[order], of_tree[order]
    parameter = np.maximum.accumulate(2.0 * edge + parameter[order]) - 2.0 * edge
    start = np.stack([arcs[profile.edges[edge, 0]] for arcs in profile.arcs], axis=1).astype(np.int64)
    border = arc[order] * len(trees) + of_tree
    return Crossings(edge, parameter, is_entry[order], border, _arcs_behind(edge, behind[order], of_tree, start))


def part_of_border(cuts: list[Ints]) -> Ints:
    """Return the part that each border cuts off, by the number of the border in crossings."""
    n_arcs = max(len(cut) for cut in cuts)
    return np.stack([np.pad(cut, (0, n_arcs - len(cut))) for cut in cuts], axis=1).ravel()


def trace_borders(mesh: TriangleMesh, crossings: Crossings, part_of_border: Ints) -> tuple[Polyline, ...]:
    """Join the crossings on the edges of a triangle mesh to lines.

    Parameters
    ----------
    mesh : TriangleMesh
    crossings : Crossings
        Of ``mesh.edges``.
    part_of_border : (n,) int64
        The part that each border cuts off.
    """
    points = _points(mesh, crossings)
    n = len(points)
    left, right = _segments(mesh, crossings)
    # A line ends where more than two triangles meet, so that it never branches.
    sound = (np.bincount(np.concatenate([left, right]), minlength=n) <= 2)[np.stack([left, right])].all(axis=0)
    left, right = left[sound], right[sound]
    graph = coo_array((np.ones(len(left)), (left, right)), shape=(n, n)).tocsr()
    graph = (graph + graph.T).tocsr()
    degree = np.diff(graph.indptr)
    lines = []
    for line in _lines(graph, degree):
        is_closed = len(line) > 2 and bool(degree[line].min() == 2)
        lines.append(Polyline(int(part_of_border[crossings.border[line[0]]]), points[line], is_closed))
    return tuple(lines)


def _lines(graph: csr_array, degree: Ints) -> list[Ints]:
    """Return the vertices of every path or ring of a graph, in their order."""
    line = connected_components(graph, directed=False)[1]
    # Ends of paths first, so that the walk along each starts at one.
    order = np.lexsort((degree, line))
    starts = order[np.append(True, np.diff(line[order]) > 0)] if len(order) else order
    walks = (depth_first_order(graph, start, directed=False, return_predecessors=False) for start in starts.tolist())
    return [walk.astype(np.int64) for walk in walks if len(walk) > 1]


def _segments(mesh: TriangleMesh, crossings: Crossings) -> tuple[Ints, Ints]:
    """Return the pairs of crossings that a border joins inside a triangle: it crosses two of its edges."""
    crossed = np.unique(crossings.edge)
    triangle, side = np.nonzero(np.isin(mesh.edges.of_triangle, crossed))
    first = np.searchsorted(crossings.edge, mesh.edges.of_triangle[triangle, side])
    count = np.searchsorted(crossings.edge, mesh.edges.of_triangle[triangle, side], side="right") - first
    row = np.repeat(first, count) + np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    owner = np.repeat(triangle, count)
    order = np.lexsort((crossings.border[row], owner))
    owner, row = owner[order], row[order]
    same = (owner[1:] == owner[:-1]) & (crossings.border[row][1:] == crossings.border[row][:-1])
    return row[:-1][same], row[1:][same]


def _points(mesh: TriangleMesh, crossings: Crossings) -> Floats:
    start, stop = mesh.vertices[mesh.edges.vertices[crossings.edge]].swapaxes(0, 1)
    return start + crossings.parameter[:, None] * (stop - start)


@dataclass(frozen=True, eq=False)
class _Passages:
    """Edges that pass borders of one tree, one row each time; ``arc`` is cut off there, ``behind`` is what follows."""

    edge: Ints
    parameter: Floats
    arc: Ints
    behind: Ints
    is_entry: Bools


def _passages(profile: EdgeProfile, number: int, tree: ArcTree, heights: Floats, cut: Ints) -> _Passages:
    """Return where edges leave and enter the parts of one tree."""
    outward = _nearest_cut(tree.parent, cut > 0)
    inner = np.where(cut > 0, np.arange(len(cut)), outward)
    edge = np.flatnonzero(~np.isnan(profile.heights).any(axis=1))
    ends = inner[profile.arcs[number][profile.edges[edge]]]
    passed = []
    while True:
        differ = np.flatnonzero(ends[:, 0] != ends[:, 1])
        edge, ends = edge[differ], ends[differ]
        # A parent has a larger index than its children: of two different arcs the smaller one is left.
        is_entry = np.where(ends < 0, len(cut), ends).argmin(axis=1) == 1
        arc = np.where(is_entry, ends[:, 1], ends[:, 0])
        passed.append((edge, arc, is_entry))
        if not len(edge):
            break
        ends = np.stack(
            [np.where(is_entry, ends[:, 0], outward[arc]), np.where(is_entry, outward[arc], ends[:, 1])], axis=1
        )
    edge, arc, is_entry = (np.concatenate(column) for column in zip(*passed, strict=True))
    from_inside = np.where(is_entry[:, None], profile.heights[edge][:, ::-1], profile.heights[edge])
    share = _first_fall((from_inside - heights[arc, None]) * (1 if tree.is_of_maxima else -1))
    behind = np.where(is_entry, arc, tree.parent[arc])
    return _Passages(edge, np.where(is_entry, 1 - share, share), arc, behind, is_entry)


def _nearest_cut(parent: Ints, is_cut: Bools) -> Ints:
    """Return for each arc the nearest cut one towards the root, itself left out; ``NO_ARC`` if there is none."""
    nearest = np.full(len(parent), NO_ARC)
    for arc in range(len(parent) - 1, -1, -1):
        if parent[arc] != NO_ARC:
            nearest[arc] = parent[arc] if is_cut[parent[arc]] else nearest[parent[arc]]
    return nearest


def _first_fall(heights: Floats) -> Floats:
    """Return the fraction (n,) of each row at which piecewise linear heights (n, m) first fall to zero."""
    above = heights > 0
    falls = above[:, :-1] & ~above[:, 1:]
    first = falls.argmax(axis=1)
    row = np.arange(len(heights))
    high, low = heights[row, first], heights[row, first + 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (first + high / (high - low)) / (heights.shape[1] - 1)
    # Where the field never falls to the level, its nearest point to the level has to do.
    nearest = np.abs(heights).argmin(axis=1) / (heights.shape[1] - 1)
    return np.where(falls.any(axis=1), share, nearest)


def _arcs_behind(edge: Ints, arc: Ints, of_tree: Ints, start: Ints) -> Ints:
    """Return the arcs behind each crossing in every tree: those before it, but for the one that is left or entered."""
    arcs = start.copy()
    place = np.arange(len(edge)) - np.searchsorted(edge, edge)
    for number in range(int(place.max(initial=-1)) + 1):
        rows = np.flatnonzero(place == number)
        if number:
            arcs[rows] = arcs[rows - 1]
        arcs[rows, of_tree[rows]] = arc[rows]
    return arcs
