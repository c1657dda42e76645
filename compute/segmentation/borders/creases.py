"""Where the surface is creased inward: people end parts there (the minima rule)."""

import numpy as np

from ...surface.cleaning import Surface
from ...surface.heat_smoothing import WIDTH_OF_UNIT_TIME, smoothed
from ...surface.mesh import Floats, TriangleMesh, area_vectors, unit_rows, vertex_normals
from ...surface.orientation import outward_triangles

# Normals are smoothed over this share of the root of the area, so that wrinkles and noise are no creases, and over as
# many edges of mean length at most.
SMOOTHING, MOST_EDGES = 0.02, 4.0
# How far off the smoothed normals may be.
TOLERANCE = 0.1
# A crease whose curvature, in the inverse root of the area, is this has half the cost of a flat place.
HALVING_CURVATURE = 15.0
# However sharp, a crease costs this share.
LEAST_COST = 0.1


def crease_costs(surface: Surface, n_rings: int) -> Floats:
    """Return (P,) what a border costs along the edge that each pair of neighbouring triangles shares.

    It is 1 where the surface is flat or bulges, and falls with the curvature across the edge where it is concave. Where
    triangles are so small that no border could move as far as a crease is wide, it is 1 everywhere.

    Parameters
    ----------
    surface : Surface
        Shells that are analyzed each by itself have creases in proportion to their own size.
    n_rings : int
        How many rings of triangles a border may move.

    References
    ----------
    .. [1] Hoffman, Richards, "Parts of Recognition", Cognition 1984: the minima rule.
    """
    mesh = surface.mesh
    if not surface.is_apart:
        return _costs(mesh, n_rings)
    costs, shell = np.ones(len(mesh.edges.shared)), mesh.component_of_triangle
    of_pair = shell[mesh.edges.neighbours[:, 0]]
    for number in range(int(shell.max()) + 1):
        used, corners = np.unique(mesh.triangles[shell == number], return_inverse=True)
        costs[of_pair == number] = _costs(TriangleMesh(mesh.vertices[used], corners.reshape(-1, 3)), n_rings)
    return costs


def _costs(mesh: TriangleMesh, n_rings: int) -> Floats:
    size = np.sqrt(mesh.areas.sum())
    edges = mesh.edges
    length = np.linalg.norm(np.diff(mesh.vertices[edges.vertices], axis=1), axis=2).mean()
    if n_rings * length < SMOOTHING * size:
        return np.ones(len(edges.shared))
    outward = outward_triangles(mesh)
    normals = vertex_normals(outward, area_vectors(mesh.vertices[outward]), len(mesh.vertices))
    radius = min(SMOOTHING * size, MOST_EDGES * length)
    normals = unit_rows(smoothed(mesh, normals, WIDTH_OF_UNIT_TIME * radius, TOLERANCE))
    opposite = mesh.triangles[edges.neighbours].sum(axis=2) - edges.vertices[edges.shared].sum(axis=1)[:, None]
    # From corner to corner, not at right angles to the edge: around a thin limb a slanting edge is less of a crease.
    across = np.diff(mesh.vertices[opposite], axis=1)[:, 0]
    turn = np.einsum("pk,pk->p", np.diff(normals[opposite], axis=1)[:, 0], across)
    square = np.einsum("pk,pk->p", across, across)
    curvature = size * np.divide(turn, square, out=np.zeros_like(turn), where=square > 0)
    concavity = np.maximum(-curvature, 0.0) / HALVING_CURVATURE
    return np.maximum(LEAST_COST, 1 / (1 + concavity**2))
