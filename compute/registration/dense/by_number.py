"""Correspondence by number: both meshes have the same triangles over the same vertices."""

import numpy as np

from ...surface.mesh import TriangleMesh
from .shape_pair import Image, nearest_known, triangle_around
from .surface_points import SurfacePoints


def map_by_number(target: TriangleMesh) -> Image:
    """Return each vertex and triangle as its own image; a vertex without triangles takes the nearest that has some."""
    triangle, corner = triangle_around(target.triangles, len(target.vertices))
    is_used = triangle >= 0
    nearest = nearest_known(target.vertices, is_used)
    points = SurfacePoints(triangle[nearest], np.eye(3)[corner[nearest]])
    return Image(points, np.arange(len(target.triangles)), is_used.astype(np.float64))
