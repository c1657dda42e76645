"""Correspondence by faces: both meshes have the same triangles under other numbers."""

import numpy as np

from ...surface.mesh import Ints
from ...surface.orientation import outward_triangles
from ..eigenfunctions.shape_points import nearest_known, shape_points
from ..eigenfunctions.zoomout import nearest_rows
from .isomorphism import isomorphism, may_be_isomorphic
from .shape_pair import Image, ShapePair, triangle_around
from .surface_points import SurfacePoints


def map_by_faces(pair: ShapePair) -> Image | None:
    """Return the source's vertex and triangle that each of the target's is; None if the faces differ."""
    vertex_map = _vertex_map(pair)
    if vertex_map is None:
        return None
    source, target, is_analyzed = pair.source, pair.target, pair.target_points.is_analyzed
    vertex = vertex_map[target.surface.vertex_of_input][nearest_known(target.mesh.vertices, is_analyzed)]
    triangle, corner = triangle_around(source.mesh.triangles, len(source.mesh.vertices))
    points = SurfacePoints(triangle[vertex], np.eye(3)[corner[vertex]])
    rows = _rows_of_triangles(source.surface.mesh.triangles, vertex_map[target.surface.mesh.triangles])
    triangles = source.surface.input_triangle[rows][target.surface.triangle_of_input]
    return Image(points, triangles, is_analyzed.astype(np.float64))


def _vertex_map(pair: ShapePair) -> Ints | None:
    """Return (Vt,) the source's vertex that each analyzed vertex is, if the faces are the same; None otherwise."""
    source, target = (outward_triangles(analysis.surface.mesh) for analysis in (pair.source, pair.target))
    if not may_be_isomorphic(source, target):
        return None
    if pair.matching.mirrored:
        source = source[:, ::-1]
    source_points = shape_points(pair.source.mesh.vertices, pair.source.surface, pair.source_shape)
    target_points = pair.target_points
    vertices = np.flatnonzero(source_points.is_analyzed)
    source_rows, target_rows = pair.embedded(source_points.point[vertices], target_points.point)
    guess = pair.source.surface.vertex_of_input[vertices[nearest_rows(target_rows, source_rows)]]
    return isomorphism(source, target, len(source_points.point), len(target_points.point), guess)


def _rows_of_triangles(triangles: Ints, wanted: Ints) -> Ints:
    """Return for each wanted triangle the row with the same corners, in whatever order."""
    rows, other = np.sort(triangles, axis=1), np.sort(wanted, axis=1)
    row = np.empty(len(wanted), dtype=np.int64)
    row[np.lexsort(other.T)] = np.lexsort(rows.T)
    return row
