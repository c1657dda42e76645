"""Two matched shapes with what every way of mapping their vertices begins with."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...analysis.analysis import Analysis
from ...surface.inner_walls import inner_vertices, inner_walls
from ...surface.mesh import Bools, Floats, Ints
from ..eigenfunctions.given_points import PointPairs, point_pairs
from ..eigenfunctions.matching import Matching
from ..eigenfunctions.shape_points import ShapePoints, shape_points
from ..eigenfunctions.spectral_shape import SpectralShape, farthest_points
from .point_map import DENSE_SAMPLES, refined_functional_map
from .surface_points import SurfacePoints


@dataclass(frozen=True, eq=False)
class Image:
    """The image of a target on a source: a place for each vertex and each triangle.

    Attributes
    ----------
    points : SurfacePoints
        On the source's input triangles, one for each of the target's Vt vertices.
    triangles : (Tt,) int64
        The source's triangle for each of the target's.
    confidence : (Vt,) float64
        From 0 to 1.
    """

    points: SurfacePoints
    triangles: Ints
    confidence: Floats


@dataclass(frozen=True, eq=False)
class Walls:
    """The inner walls of a spectral shape of n points and m triangles.

    Attributes
    ----------
    of_surface : (T',) bool
        Of the surface that was analyzed.
    triangles : (m,) bool
    points : (n,) bool
        Points with inner triangles around them and no others.
    """

    of_surface: Bools
    triangles: Bools
    points: Bools


@dataclass(frozen=True, eq=False)
class ShapePair:
    """Two analyzed shapes and how their functions match.

    Attributes
    ----------
    source, target : Analysis
    source_shape : SpectralShape
        The mirror image if the source was matched so.
    target_shape : SpectralShape
    matching : Matching
    """

    source: Analysis
    target: Analysis
    source_shape: SpectralShape
    target_shape: SpectralShape
    matching: Matching

    @cached_property
    def samples(self) -> Ints:
        """(s,) points of the source that lie far from each other."""
        return farthest_points(self.source_shape.positions, DENSE_SAMPLES)

    @cached_property
    def given(self) -> PointPairs:
        """The points that were given."""
        shapes = self.source_shape, self.target_shape
        return point_pairs(self.matching.points, self.source.surface, self.target.surface, *shapes)

    @cached_property
    def functional_map(self) -> Floats:
        """(kt, ks) the matching grown to all functions, target x source, the constant included."""
        shapes = self.source_shape, self.target_shape
        return refined_functional_map(*shapes, self.matching, self.samples, pairs=self.given)

    @cached_property
    def target_points(self) -> ShapePoints:
        """The target's points for the vertices of its input."""
        return shape_points(self.target.mesh.vertices, self.target.surface, self.target_shape)

    @cached_property
    def source_walls(self) -> Walls:
        """The inner walls of the source."""
        return _walls(self.source, self.source_shape)

    @cached_property
    def target_walls(self) -> Walls:
        """The inner walls of the target."""
        return _walls(self.target, self.target_shape)

    def embedded(self, source_points: Ints, target_points: Ints) -> tuple[Floats, Floats]:
        """Return points of both shapes in the space where the functional map makes them comparable."""
        n_target, n_source = self.functional_map.shape
        source_rows = self.source_shape.functions[source_points, :n_source] @ self.functional_map.T
        return source_rows, self.target_shape.functions[target_points, :n_target]


def _walls(analysis: Analysis, shape: SpectralShape) -> Walls:
    of_surface = inner_walls(analysis.surface.mesh)
    triangles = of_surface[analysis.surface.triangle_of_input[shape.input_triangle]]
    return Walls(of_surface, triangles, inner_vertices(shape.triangles, triangles, len(shape.positions)))


def triangle_around(triangles: Ints, n_vertices: int) -> tuple[Ints, Ints]:
    """Return for each vertex a triangle around it, -1 if there is none, and the corner of it that the vertex is."""
    side = np.full(n_vertices, -3)
    side[triangles.ravel()] = np.arange(triangles.size)
    return side // 3, side % 3
