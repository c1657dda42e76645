"""The map by place: where one mesh lies on another, as clothes on a body do, the nearest point is the right one."""

import numpy as np

from ...surface.cleaning import welded_vertices
from ...surface.mesh import Floats, TriangleMesh, area_vectors, unit_rows
from .shape_pair import Image
from .surface_points import SurfaceTree

# A vertex is in doubt whose nearest point is farther away than this share of the target's diagonal, or where the
# surfaces are turned from each other by more than this angle, either side of the cloth: Abdrashitov et al., "Robust
# Skin Weights Transfer via Weight Inpainting", SIGGRAPH Asia 2023.
NEAR, ANGLE = 0.05, np.radians(30)
# How much farther away, likewise, a point may be that looks the same way: the other leg looks against it, and so does
# the other side of thick cloth.
SAME_WAY = 0.01
N_CANDIDATES = 24


def map_by_place(source: TriangleMesh, target: TriangleMesh) -> Image:
    """Return where the vertices of a target lie on a source, which is at the same place in space.

    Parameters
    ----------
    source, target : TriangleMesh
        In one space, such as the world.
    """
    diagonal = float(np.linalg.norm(np.ptp(target.vertices[target.used], axis=0)))
    tree = SurfaceTree(source.vertices, source.triangles, turn=SAME_WAY * diagonal, wrong_side=SAME_WAY * diagonal)
    normals = _vertex_normals(target)
    points, distance = tree.nearest(target.vertices, normals, N_CANDIDATES)
    landed = unit_rows(points.blend(_vertex_normals(source), source.triangles))
    angle = np.arccos(np.clip(np.abs((landed * normals).sum(axis=1)), 0, 1))
    doubt = (distance / (NEAR * diagonal)) ** 4 + (angle / ANGLE) ** 4
    corners = target.vertices[target.triangles]
    middles, _ = tree.nearest(corners.mean(axis=1), unit_rows(area_vectors(corners)), N_CANDIDATES)
    return Image(points, middles.triangles, 1 / (1 + doubt))


def _vertex_normals(mesh: TriangleMesh) -> Floats:
    """Return (V, 3) unit normals, the same for all vertices at one place along a seam."""
    place = welded_vertices(mesh)
    sums = np.zeros_like(mesh.vertices)
    np.add.at(sums, place[mesh.triangles.ravel()], np.repeat(area_vectors(mesh.vertices[mesh.triangles]), 3, axis=0))
    return unit_rows(sums)[place]
