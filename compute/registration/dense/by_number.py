"""Correspondence by number: both meshes have the same analyzed triangles over the same vertices."""

import numpy as np

from ...analysis.analysis import Analysis
from ..eigenfunctions.shape_points import nearest_known
from .shape_pair import Image, triangle_around
from .surface_points import SurfacePoints


def map_by_number(source: Analysis, target: Analysis) -> Image:
    """Return each vertex and triangle as its own image; a vertex without triangles takes the nearest that has some."""
    n_vertices = len(target.mesh.vertices)
    triangle, corner = triangle_around(source.mesh.triangles, n_vertices)
    is_used = np.zeros(n_vertices, dtype=bool)
    is_used[target.mesh.used] = True
    is_used &= triangle >= 0
    nearest = nearest_known(target.mesh.vertices, is_used)
    points = SurfacePoints(triangle[nearest], np.eye(3)[corner[nearest]])
    triangles = np.arange(len(target.mesh.triangles))
    if not np.array_equal(source.mesh.triangles, target.mesh.triangles):
        # Repeated and collapsed faces are not analyzed: with others of them, triangles have other numbers.
        triangles = source.surface.input_triangle[target.surface.triangle_of_input]
    return Image(points, triangles, is_used.astype(np.float64))
