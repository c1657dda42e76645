"""The vertices of an input mesh as points of its spectral shape."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...surface.cleaning import Surface
from ...surface.mesh import Bools, Floats, Ints
from .spectral_shape import SpectralShape


@dataclass(frozen=True, eq=False)
class ShapePoints:
    """The point of a spectral shape for each of the V vertices of the input.

    Attributes
    ----------
    point : (V,) int64
        For vertices that are not on the shape that of the nearest vertex in space that is.
    is_analyzed : (V,) bool
        Whether the vertex is on the shape.
    """

    point: Ints
    is_analyzed: Bools


def shape_points(vertices: Floats, surface: Surface, shape: SpectralShape) -> ShapePoints:
    """Return the points of the spectral shape of a surface for the vertices (V, 3) of its input."""
    point = np.full(len(vertices), -1)
    is_vertex = shape.node < len(vertices)
    point[shape.node[is_vertex]] = np.flatnonzero(is_vertex)
    point = point[surface.vertex_of_input]
    is_analyzed = point >= 0
    return ShapePoints(point[nearest_known(vertices, is_analyzed)], is_analyzed)


def nearest_known(vertices: Floats, is_known: Bools) -> Ints:
    """Return for each vertex (V, 3) itself or, if it is not known, the nearest in space that is."""
    nearest = np.arange(len(vertices))
    lone = np.flatnonzero(~is_known)
    if len(lone):
        known = np.flatnonzero(is_known)
        nearest[lone] = known[cKDTree(vertices[known]).query(vertices[lone])[1]]
    return nearest
