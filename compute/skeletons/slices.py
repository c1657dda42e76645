"""The level sets along the arcs of a Reeb graph, gathered in slices: their centres and girths."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..analysis.analysis import Analysis
from ..msc.reeb import ReebGraph
from ..surface.mesh import Floats, Ints
from ..surface.ties import ROUNDING, evened, first_largest

# Slices of an arc, at the most, and net triangles in a slice, at the least: thinner ones have no reliable centre.
MOST_SLICES = 48
LEAST_TRIANGLES = 40
# Of the mean rise of an arc's slices, at the least.
LEAST_RISE = 0.05
# Where a field is level, its gradients are this fraction of the steepest, and slices this thin in sizes of the shape.
LEVEL = 1e-9


@dataclass(frozen=True, eq=False)
class Slices:
    """Slices of equal area of all arcs, one arc after the other, each rising; S slices, m net triangles.

    Attributes
    ----------
    offset : (A + 1,) int64
        The first slice of each arc.
    of_triangle : (m,) int64
        The slice that each net triangle lies in.
    weight : (m,) float64
        Mean length of the level sets inside each triangle times the height it rises.
    girth : (S,) float64
        Mean length of the level sets.
    length : (S,) float64
        Area by girth: the reach of a slice along its limb.
    part : (S,) int64
        The label that most of the area has.
    """

    offset: Ints
    of_triangle: Ints
    weight: Floats
    girth: Floats
    length: Floats
    part: Ints

    @property
    def count(self) -> int:
        """Number of slices."""
        return len(self.girth)

    @property
    def radius(self) -> Floats:
        """(S,) radius of a circle of the girth."""
        return self.girth / (2 * np.pi)

    def of_arc(self, arc: int) -> Ints:
        """Return the slices of an arc, rising."""
        return np.arange(self.offset[arc], self.offset[arc + 1])

    def means(self, points: Floats) -> Floats:
        """Return (S, 3) the centres of the slices, given the centres (m, 3) of the triangles in any pose.

        Weighted so that it is the mean of the centres of the level sets, however wide they lie apart.
        """
        total = np.bincount(self.of_triangle, self.weight, self.count)
        sums = [np.bincount(self.of_triangle, self.weight * column, self.count) for column in points.T]
        return np.stack(sums, axis=1) / total[:, None]


def slice_arcs(analysis: Analysis, graph: ReebGraph, labels: NDArray[np.int32]) -> Slices:
    """Cut the arcs of a Reeb graph into slices of equal area.

    Parameters
    ----------
    analysis : Analysis
    graph : ReebGraph
        Of its field.
    labels : (T,) int32
        Part of each triangle of the input.
    """
    net, values = analysis.net, analysis.field.values
    height = _means_of_corners(values[net.triangles.T])
    offset, of_triangle, lowest = _equal_areas(graph.arc_of_triangle, len(graph.arcs), height, net.areas)
    weight = _level_lengths(net.positions[net.triangles], values[net.triangles])
    n_slices = int(offset[-1])
    total = np.bincount(of_triangle, weight, n_slices)
    area = np.bincount(of_triangle, net.areas, n_slices)
    rises = _rises(lowest, offset, values[graph.vertex[graph.arcs]], ROUNDING * analysis.field.value_range)
    size = float(np.linalg.norm(np.ptp(net.positions[net.used], axis=0)))
    # Nothing is wider than the shape, whatever a level field makes of it.
    with np.errstate(over="ignore"):
        girth = np.clip(total / rises, LEVEL * size, np.pi * size)
    label = labels[analysis.surface.input_triangle[net.triangle_of_surface]]
    return Slices(
        offset=offset,
        of_triangle=of_triangle,
        weight=weight,
        girth=girth,
        length=area / girth,
        part=_main_labels(of_triangle, label, net.areas),
    )


def centres_at_rest(analysis: Analysis) -> Floats:
    """Return (m, 3) the centres of the net's triangles."""
    return _means_of_corners(analysis.net.positions[analysis.net.triangles.T])


def centres_in_pose(analysis: Analysis, vertices: Floats) -> Floats:
    """Return (m, 3) the centres of the net's triangles when the (V, 3) vertices of the input lie elsewhere."""
    surface = analysis.surface.mesh
    corners = surface.triangles[analysis.net.triangle_of_surface]
    weights = _barycentric(surface.vertices[corners], centres_at_rest(analysis))
    return np.einsum("mk,mkj->mj", weights, vertices[corners])


def _means_of_corners(values: Floats) -> Floats:
    """Return the means over the first of three rows; adding them is faster than ``mean``."""
    first, second, third = values
    return (first + second + third) / 3


def _equal_areas(arc: Ints, n_arcs: int, height: Floats, area: Floats) -> tuple[Ints, Ints, Floats]:
    """Return the first slice of each arc, the slice of each triangle, and the lowest height in each slice."""
    # Triangles of one ring of a regular limb are equally high: they stay in one slice, whatever their order.
    level = evened(height, float(np.ptp(height)))
    order = np.lexsort((level, arc))
    count = np.bincount(arc, minlength=n_arcs)
    n_slices = np.clip(count // LEAST_TRIANGLES, 1, MOST_SLICES)
    arc, total = arc[order], np.bincount(arc, area, n_arcs)
    below = np.cumsum(area[order]) - area[order]
    start = np.append(below, 0.0)[np.cumsum(count) - count]
    is_higher = np.append(True, (np.diff(level[order]) != 0) | (np.diff(arc) != 0))
    below = below[is_higher][np.cumsum(is_higher) - 1]
    share = (below - start[arc]) / np.maximum(total[arc], np.finfo(float).tiny)
    place = np.clip(((share + ROUNDING) * n_slices[arc]).astype(np.int64), 0, n_slices[arc] - 1)
    # A single large triangle can reach over several slices: those behind it are left out.
    keys, first, slice_in_order = np.unique(arc * MOST_SLICES + place, return_index=True, return_inverse=True)
    of_triangle = np.empty(len(arc), dtype=np.int64)
    of_triangle[order] = slice_in_order.reshape(-1)
    return np.searchsorted(keys, np.arange(n_arcs + 1) * MOST_SLICES), of_triangle, height[order][first]


def _level_lengths(corners: Floats, values: Floats) -> Floats:
    """Return (m,) gradient times area, which is the integral of the length of the level sets over their heights."""
    opposite = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    rise = np.linalg.norm(np.einsum("mi,mij->mj", values, opposite), axis=1) / 2
    # A triangle on which the field is level still has a place.
    return np.maximum(rise, LEVEL * (float(rise.max()) or 1.0))


def _rises(lowest: Floats, offset: Ints, ends: Floats, least: float) -> Floats:
    """Return (S,) the rise of the field through each slice, given the ends (A, 2) of the arcs, at least the last."""
    count = np.diff(offset)
    filled = np.flatnonzero(count)
    bottom = lowest.copy()
    bottom[offset[filled]] = np.minimum(bottom[offset[filled]], ends[filled, 0])
    top = np.append(bottom[1:], 0.0)
    top[offset[filled + 1] - 1] = ends[filled, 1]
    # Triangles across the level of a saddle reach a little below their arc.
    even = np.repeat((ends[:, 1] - ends[:, 0]) / np.maximum(count, 1), count)
    return np.maximum(top - bottom, np.maximum(LEAST_RISE * even, max(least, float(np.finfo(float).tiny))))


def _main_labels(of_triangle: Ints, label: NDArray[np.int32], area: Floats) -> Ints:
    n_labels = int(label.max(initial=0)) + 1
    n_slices = int(of_triangle.max()) + 1
    shares = np.bincount(of_triangle * n_labels + label, area, n_slices * n_labels)
    return first_largest(shares.reshape(n_slices, n_labels))


def _barycentric(corners: Floats, points: Floats) -> Floats:
    """Return (m, 3) barycentric coordinates of points in their triangles; the middle of triangles without area."""
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal = np.cross(first, second)
    square = np.einsum("mj,mj->m", normal, normal)
    to_point = points - corners[:, 0]
    flat = square <= 0
    square[flat] = 1.0
    one = np.einsum("mj,mj->m", np.cross(to_point, second), normal) / square
    two = np.einsum("mj,mj->m", np.cross(first, to_point), normal) / square
    weights = np.stack([1 - one - two, one, two], axis=1)
    weights[flat] = 1 / 3
    return weights
