"""The map by place: where one mesh lies on another, as clothes on a body do, the nearest point is the right one."""

import numpy as np

from ...memory import told_if_full
from ...surface.cleaning import welded_vertices
from ...surface.mesh import Bools, Floats, TriangleMesh, area_vectors, unit_rows, vertex_normals
from .confidence import SURE
from .shape_pair import Image
from .surface_points import SurfacePoints, SurfaceTree

# A vertex is in doubt whose nearest point is farther away than this share of the diagonal of the larger mesh, or where
# the surfaces are turned from each other by more than this angle, either side of the cloth: after Abdrashitov et al.,
# "Robust Skin Weights Transfer via Weight Inpainting", SIGGRAPH Asia 2023.
NEAR, ANGLE = 0.05, np.radians(30)
# How much farther away, likewise, a point may be that looks the same way: the other leg looks against it, and so does
# the other side of thick cloth.
SAME_WAY = 0.005
N_CANDIDATES = 24
# Places that are looked for at once; each takes 20 kB.
AT_ONCE = 20_000
# One of two meshes is a piece on the other, such as clothes, if this share of it lies there and clearly less of the
# other on it, or at least half of it and of the other little (docs/transfer.md).
WHOLE, CLEARLY = 0.95, 0.04
HALF, LITTLE = 0.5, 0.6
# Both are the same surface with other faces if they lie there as wholes, no farther away than this share of the
# diagonal.
SAME_SURFACE = 0.005


@told_if_full
def map_by_place(source: TriangleMesh, target: TriangleMesh) -> Image:
    """Return where the vertices of a target lie on a source, which is at the same place in space.

    Parameters
    ----------
    source, target : TriangleMesh
        In one space, such as the world.
    """
    tree = _tree_of(source, target)
    points, confidence = _landed(tree, source, target)
    corners = target.vertices[target.triangles]
    middles, _ = _nearest(tree, corners.mean(axis=1), unit_rows(area_vectors(corners)))
    return Image(points, middles.triangles, confidence)


@told_if_full
def lie_together(source: TriangleMesh, target: TriangleMesh, points: SurfacePoints, is_sure: Bools) -> bool:
    """Whether one of two meshes lies on the other as clothes do on a body, or is the same surface with other faces.

    Parameters
    ----------
    source, target : TriangleMesh
    points : SurfacePoints
        Where the vertices of the target lie by place.
    is_sure : (Vt,) bool
    """
    _, back = _landed(_tree_of(target, source), target, source)
    less, more = sorted((_share_of_area(target, is_sure), _share_of_area(source, back >= SURE)))
    if (more >= WHOLE and less < more - CLEARLY) or (more >= HALF and less < LITTLE * more):
        return True
    gaps = np.linalg.norm(points.blend(source.vertices, source.triangles) - target.vertices, axis=1)
    nearly_all = np.quantile(gaps[target.used], WHOLE)
    return less >= WHOLE and bool(nearly_all <= SAME_SURFACE * _largest_diagonal(source, target))


def _largest_diagonal(*meshes: TriangleMesh) -> float:
    """Return the diagonal of the largest box around one of some meshes."""
    return max(float(np.linalg.norm(np.ptp(mesh.vertices[mesh.used], axis=0))) for mesh in meshes)


def _tree_of(source: TriangleMesh, target: TriangleMesh) -> SurfaceTree:
    same_way = SAME_WAY * _largest_diagonal(source, target)
    return SurfaceTree(source.vertices, source.triangles, turn=same_way, wrong_side=same_way)


def _landed(tree: SurfaceTree, source: TriangleMesh, target: TriangleMesh) -> tuple[SurfacePoints, Floats]:
    """Return where the vertices of a target land on a source, of which there is a tree, and with what confidence."""
    normals = _vertex_normals(target)
    points, distance = _nearest(tree, target.vertices, normals)
    landed = unit_rows(points.blend(_vertex_normals(source), source.triangles))
    angle = np.arccos(np.clip(np.abs((landed * normals).sum(axis=1)), 0, 1))
    doubt = (distance / (NEAR * _largest_diagonal(source, target))) ** 4 + (angle / ANGLE) ** 4
    return points, 1 / (1 + doubt)


def _nearest(tree: SurfaceTree, places: Floats, normals: Floats) -> tuple[SurfacePoints, Floats]:
    """Return the nearest points and their distances, a part of them at a time."""
    parts = [slice(start, start + AT_ONCE) for start in range(0, len(places), AT_ONCE)]
    found = [tree.nearest(places[part], normals[part], N_CANDIDATES) for part in parts]
    triangles = np.concatenate([points.triangles for points, _ in found])
    barycentric = np.concatenate([points.barycentric for points, _ in found])
    return SurfacePoints(triangles, barycentric), np.concatenate([distance for _, distance in found])


def _share_of_area(mesh: TriangleMesh, is_sure: Bools) -> float:
    """Return the share of the area of a mesh that is sure; vertices may be crowded in the face."""
    return float(is_sure[mesh.triangles].mean(axis=1) @ mesh.areas / mesh.areas.sum())


def _vertex_normals(mesh: TriangleMesh) -> Floats:
    """Return (V, 3) unit normals, the same for all vertices at one place along a seam."""
    place = welded_vertices(mesh)
    vectors = area_vectors(mesh.vertices[mesh.triangles])
    return vertex_normals(place[mesh.triangles], vectors, len(mesh.vertices))[place]
