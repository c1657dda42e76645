"""Pairs of points that the user gives: a vertex of the source and the vertex of the target that it belongs to."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import dijkstra

from ...errors import RegistrationError
from ...surface.cleaning import Surface
from ...surface.mesh import Floats, Ints
from .edge_paths import edge_paths
from .map_scoring import Candidate
from .shape_points import shape_points
from .spectral_shape import SpectralShape
from .zoomout import nearest_points

# A point that lands farther from its partner than the second contradicts the map, on a surface of area 1; right maps of
# the first functions are mostly off by 0.02, and less than the first.
CLOSE, FAR = 0.05, 0.15
# How much more a map may cost than one that misses a point: what symmetries leave open differs by less, and only maps
# that cost much more meet wrong points.
WORTH = 30.0
# A point that was given wrongly leaves so much of the confidence: all else may be right. So do points against which
# there is a map that is surer without them than this: one click on the wrong side turns a whole body round.
LEAST_TRUST, SURE_WITHOUT = 0.1, 0.75
# Numbers beyond which nothing changes, but sums and products stay finite: a length between points that no path joins,
# and the cost of missing many points.
LONGEST, MOST = 10.0, 1e100


@dataclass(frozen=True, eq=False)
class PointPairs:
    """Pairs of points of two spectral shapes that belong together.

    Attributes
    ----------
    vertices : (p, 2) int64
        The vertices of source and target, as they were given.
    source, target : (p,) int64
        Points of the shapes; for vertices that were not analyzed the nearest that were.
    """

    vertices: Ints
    source: Ints
    target: Ints


@dataclass(frozen=True, eq=False)
class PointFit:
    """How well maps from a source to a target send the points of some pairs to each other."""

    pairs: PointPairs
    source: SpectralShape
    target: SpectralShape

    @cached_property
    def lengths(self) -> Floats:
        """(p, n) length of the shortest path along edges from the source's point of each pair to all points."""
        lengths = dijkstra(edge_paths(self.source), directed=False, indices=self.pairs.source)
        return np.minimum(lengths, LONGEST)

    def gaps(self, functional_map: Floats) -> Floats:
        """Return (p,) the length from the source's point of each pair to where the target's lands."""
        landed = nearest_points(functional_map, self.source.functions, self.target.functions[self.pairs.target])
        return self.lengths[np.arange(len(landed)), landed]

    def gaps_by_number(self) -> Floats:
        """Return (p,) these lengths if all points correspond by their numbers."""
        return self.lengths[np.arange(len(self.pairs.target)), self.pairs.target]

    def handicapped(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Return candidates that cost more the farther they send the points from their partners."""
        return [replace(one, handicap=_handicap(self.gaps(one.functional_map))) for one in candidates]


def relative_to(best: Candidate, candidates: Sequence[Candidate]) -> list[Candidate]:
    """Return candidates with handicaps in units of that of the best, whose own cost then is what its map costs."""
    return [replace(one, handicap=one.handicap / best.handicap) for one in candidates]


def _handicap(gaps: Floats) -> float:
    share = np.clip((gaps - CLOSE) / (FAR - CLOSE), 0, 1)
    return min(float(np.prod(1 + (WORTH - 1) * share**2)), MOST)


def trust_in(gaps: Floats) -> float:
    """Return the share of a confidence that is left: one half if the point that is farthest off is just too far."""
    return max(LEAST_TRUST, float(1 / (1 + (gaps.max(initial=0) / FAR) ** 4)))


def point_warnings(gaps: Floats, sure_without: float, numbers: Sequence[int] | None = None) -> tuple[str, ...]:
    """Return a sentence for each point that contradicts the map, and one where they overrule a sure one.

    Parameters
    ----------
    gaps : (p,) float64
        From where the map puts each point to where it was given.
    sure_without : float
        The probability of another map that is likeliest without the points.
    numbers : sequence of int, optional
        By which points are told; from 1 if None.
    """
    told = "Point {} contradicts everything else, which puts it {:.0%} of the size of the shape away; check it on both."
    overruled = "The points overrule another matching, which is {:.0%} sure without them; look at their sides."
    numbers = range(1, 1 + len(gaps)) if numbers is None else numbers
    wrong = [told.format(number, gap) for number, gap in zip(numbers, gaps.tolist(), strict=True) if gap > FAR]
    return (*wrong, *([overruled.format(sure_without)] if sure_without > SURE_WITHOUT else ()))


def point_pairs(
    vertices: Ints, source: Surface, target: Surface, source_shape: SpectralShape, target_shape: SpectralShape
) -> PointPairs:
    """Return checked pairs of vertices of two surfaces (p, 2) as points of their shapes."""
    if not len(vertices):
        return PointPairs(vertices, vertices[:, 0], vertices[:, 1])
    known = ((source, source_shape), (target, target_shape))
    points = [shape_points(surface.mesh.vertices, surface, shape).point for surface, shape in known]
    return PointPairs(vertices, points[0][vertices[:, 0]], points[1][vertices[:, 1]])


def checked_points(points: ArrayLike | None, source: Surface, target: Surface) -> Ints:
    """Return (p, 2) pairs of vertices of the inputs of two surfaces; none if None.

    Raises
    ------
    RegistrationError
        If they are no pairs of whole numbers, a shape has no such vertex, or one has no face or is in two pairs.
    """
    pairs = _as_pairs([] if points is None else points)
    for column, (name, surface) in enumerate((("source", source), ("target", target))):
        n_vertices = len(surface.vertex_of_input)
        for number, vertex in enumerate(pairs[:, column].tolist(), start=1):
            if not 0 <= vertex < n_vertices:
                told = f"Point {number} names vertex {vertex} of the {name}, which has vertices 0 to {n_vertices - 1}."
                raise RegistrationError(told)
            if vertex in surface.faceless:
                raise RegistrationError(f"Vertex {vertex} of the {name} has no face; give another one as a point.")
        kinds, first, count = np.unique(pairs[:, column], return_index=True, return_counts=True)
        if (count > 1).any():
            twice = kinds[count > 1][first[count > 1].argmin()]
            raise RegistrationError(f"Vertex {twice} of the {name} is in two pairs of points; leave one of them out.")
    return pairs


def _as_pairs(points: ArrayLike) -> Ints:
    told = "Points are given as pairs of whole numbers: a vertex of the source and one of the target."
    try:
        pairs = np.asarray(points)
    except ValueError as error:
        raise RegistrationError(told) from error
    if pairs.size == 0 and pairs.ndim <= 2:
        return np.empty((0, 2), dtype=np.int64)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or pairs.dtype.kind not in "iu":
        raise RegistrationError(told)
    return pairs.astype(np.int64)
