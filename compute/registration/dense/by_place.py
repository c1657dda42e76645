"""The map by place: where one mesh lies on another, as clothes on a body do, the nearest point is the right one."""

import numpy as np

from ...surface.cleaning import welded_vertices
from ...surface.mesh import Floats, TriangleMesh, area_vectors, unit_rows
from .confidence import SURE
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
# One of two meshes is a piece on the other, such as clothes, if at least the first share of it lies there, and of the
# other less than the second times as much lies on it. Tights on a body have 0.98 and 0.41, a skirt 0.55 and 0.08; of
# poses of one character that stand on one another equal shares do (docs/transfer.md).
LEAST_OVERLAP, PIECE = 0.5, 0.6
# Both are the same surface with other faces if this share lies there, and is no farther away than this share of the
# target's diagonal.
SAME_PLACE, SAME_SURFACE = 0.95, 0.005


def map_by_place(source: TriangleMesh, target: TriangleMesh, diagonal: float | None = None) -> Image:
    """Return where the vertices of a target lie on a source, which is at the same place in space.

    Parameters
    ----------
    source, target : TriangleMesh
        In one space, such as the world.
    diagonal : float, optional
        Of which distances are shares; that of the target if None.
    """
    diagonal = diagonal_of(target) if diagonal is None else diagonal
    tree = SurfaceTree(source.vertices, source.triangles, turn=SAME_WAY * diagonal, wrong_side=SAME_WAY * diagonal)
    normals = _vertex_normals(target)
    points, distance = tree.nearest(target.vertices, normals, N_CANDIDATES)
    landed = unit_rows(points.blend(_vertex_normals(source), source.triangles))
    angle = np.arccos(np.clip(np.abs((landed * normals).sum(axis=1)), 0, 1))
    doubt = (distance / (NEAR * diagonal)) ** 4 + (angle / ANGLE) ** 4
    corners = target.vertices[target.triangles]
    middles, _ = tree.nearest(corners.mean(axis=1), unit_rows(area_vectors(corners)), N_CANDIDATES)
    return Image(points, middles.triangles, 1 / (1 + doubt))


def diagonal_of(mesh: TriangleMesh) -> float:
    """Return the diagonal of the box around a mesh."""
    return float(np.linalg.norm(np.ptp(mesh.vertices[mesh.used], axis=0)))


def lie_together(source: TriangleMesh, target: TriangleMesh) -> bool:
    """Whether one of two meshes lies on the other as clothes do on a body, or is the same surface with other faces."""
    diagonal = min(diagonal_of(source), diagonal_of(target))
    there, back = map_by_place(source, target, diagonal), map_by_place(target, source, diagonal)
    less, more = sorted((_share_of_area(target, there), _share_of_area(source, back)))
    if more >= LEAST_OVERLAP and less < PIECE * more:
        return True
    gaps = np.linalg.norm(there.points.blend(source.vertices, source.triangles) - target.vertices, axis=1)
    return less >= SAME_PLACE and bool(np.quantile(gaps[target.used], SAME_PLACE) <= SAME_SURFACE * diagonal)


def _share_of_area(mesh: TriangleMesh, image: Image) -> float:
    """Return the share of the area of a mesh that is sure; vertices may be crowded in the face."""
    is_sure = image.confidence >= SURE
    return float(is_sure[mesh.triangles].mean(axis=1) @ mesh.areas / mesh.areas.sum())


def _vertex_normals(mesh: TriangleMesh) -> Floats:
    """Return (V, 3) unit normals, the same for all vertices at one place along a seam."""
    place = welded_vertices(mesh)
    sums = np.zeros_like(mesh.vertices)
    np.add.at(sums, place[mesh.triangles.ravel()], np.repeat(area_vectors(mesh.vertices[mesh.triangles]), 3, axis=0))
    return unit_rows(sums)[place]
