"""Distances along a surface between points on its triangles: shortest paths over edges and across them."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from benchmarks.posed_families import SurfacePoints
from compute.surface.mesh import Floats, Ints, TriangleMesh

# Path searches that are done at once, which bounds the memory.
CHUNK = 256


class SurfaceDistances:
    """Measures on one mesh; within triangles that share a corner the straight line is taken."""

    def __init__(self, mesh: TriangleMesh) -> None:
        self._mesh = mesh
        self._paths = _paths(mesh)

    def between(self, one: SurfacePoints, other: SurfacePoints) -> Floats:
        """Return (n,) the distance of each pair of points."""
        mesh = self._mesh
        straight = np.linalg.norm(one.on(mesh) - other.on(mesh), axis=1)
        corners = mesh.triangles[one.triangle], mesh.triangles[other.triangle]
        is_near = (corners[0][:, :, None] == corners[1][:, None, :]).any(axis=(1, 2))
        far = np.flatnonzero(~is_near)
        distance = straight.copy()
        if len(far):
            legs = [self._legs(points, far) for points in (one, other)]
            along = self._along(corners[0][far], corners[1][far], *legs)
            distance[far] = np.maximum(along, straight[far])
        return distance

    def _legs(self, points: SurfacePoints, chosen: Ints) -> Floats:
        """Return (c, 3) how far points are from the corners of their triangles."""
        corners = self._mesh.vertices[self._mesh.triangles[points.triangle[chosen]]]
        return np.linalg.norm(corners - points.on(self._mesh)[chosen][:, None], axis=2)

    def _along(self, starts: Ints, stops: Ints, first_legs: Floats, last_legs: Floats) -> Floats:
        sources, place = np.unique(starts, return_inverse=True)
        place = place.reshape(-1, 3)
        best = np.full(len(starts), np.inf)
        for first in range(0, len(sources), CHUNK):
            found = dijkstra(self._paths, directed=False, indices=sources[first : first + CHUNK])
            for corner in range(3):
                here = place[:, corner] - first
                rows = np.flatnonzero((here >= 0) & (here < len(found)))
                total = found[here[rows, None], stops[rows]] + last_legs[rows] + first_legs[rows, corner, None]
                best[rows] = np.minimum(best[rows], total.min(axis=1))
        return best


def _paths(mesh: TriangleMesh):
    edges, n = mesh.edges, len(mesh.vertices)
    across, lengths = _across(mesh)
    ends = np.concatenate([edges.vertices, across])
    sides = np.linalg.norm(mesh.vertices[edges.vertices[:, 0]] - mesh.vertices[edges.vertices[:, 1]], axis=1)
    weights = np.maximum(np.concatenate([sides, lengths]), 1e-12)
    return coo_array((weights, (ends[:, 0], ends[:, 1])), shape=(n, n)).tocsr()


def _across(mesh: TriangleMesh) -> tuple[Ints, Floats]:
    """Return pairs of corners opposite to an edge, and how far apart they are over the edge, unfolded."""
    edges, triangles = mesh.edges, mesh.triangles
    ends = edges.vertices[edges.shared]
    opposite = triangles[edges.neighbours].sum(axis=2) - ends.sum(axis=1)[:, None]
    a, b = mesh.vertices[ends].swapaxes(0, 1)
    length = np.linalg.norm(b - a, axis=1)
    along = (b - a) / np.maximum(length, 1e-30)[:, None]
    flat = []
    for corner in opposite.T:
        away = mesh.vertices[corner] - a
        x = np.einsum("ij,ij->i", away, along)
        flat.append((x, np.linalg.norm(away - x[:, None] * along, axis=1)))
    (x, height), (other_x, other_height) = flat
    crossing = x + (other_x - x) * height / np.maximum(height + other_height, 1e-30)
    inside = (crossing >= 0) & (crossing <= length)
    return opposite[inside], np.hypot(x - other_x, height + other_height)[inside]
