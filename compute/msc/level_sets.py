"""Level sets of a piecewise linear field."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, depth_first_order

from ..surface.mesh import Floats, Ints
from .links import Links


@dataclass(frozen=True, eq=False)
class LevelSet:
    """Points on the edges of the net where the field has one value, and the segments between them.

    Attributes
    ----------
    points : (p, 3) float64
    segments : (s, 2) int64
        Pairs of points that a triangle joins.
    """

    points: Floats
    segments: Ints

    def lines(self) -> list[Floats]:
        """Return the segments as polylines, (q, 3) each; closed ones end at the point they start from."""
        n = len(self.points)
        left, right = self.segments.T
        graph = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n, n)).tocsr()
        degree = np.bincount(self.segments.ravel(), minlength=n)
        _, component = connected_components(graph, directed=False)
        # Ends of open lines come first, so that a line is not entered in its middle.
        by_degree = np.argsort(degree, kind="stable")
        starts = by_degree[np.unique(component[by_degree], return_index=True)[1]]
        return [line for start in starts.tolist() for line in self._from(graph, start, bool(degree[start] == 2))]

    def _from(self, graph: csr_array, start: int, is_closed: bool) -> list[Floats]:
        order, before = depth_first_order(graph, start, directed=False)
        # Where sheets meet, the walk goes back to a point from which another way leads on.
        jumps = np.flatnonzero(before[order[1:]] != order[:-1]) + 1
        lines = np.split(order, jumps)
        lines[1:] = [np.append(before[line[0]], line) for line in lines[1:]]
        if is_closed and len(lines) == 1:
            lines[0] = np.append(lines[0], start)
        return [self.points[line] for line in lines]


def level_set(links: Links, positions: Floats, values: Floats, height: float) -> LevelSet:
    """Return the level set of a field at a height; corners at just this height count as above it."""
    ends = links.edges.vertices
    is_above = values >= height
    crossed = is_above[ends[:, 0]] != is_above[ends[:, 1]]
    low, high = ends[crossed].T
    share = (height - values[low]) / (values[high] - values[low])
    points = positions[low] + share[:, None] * (positions[high] - positions[low])
    number = np.cumsum(crossed) - 1
    sides = links.edges.of_triangle[crossed[links.edges.of_triangle].sum(axis=1) == 2]
    segments = number[sides[crossed[sides]]].reshape(-1, 2)
    return LevelSet(points, segments)
