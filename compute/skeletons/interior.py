"""The inside of a surface: the points that lie in it, and the nearest place in the middle of the flesh."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ..surface.cleaning import Surface
from ..surface.mesh import Bools, Floats, Ints, area_vectors, vertex_normals
from ..surface.orientation import wrongly_wound
from ..surface.ties import CHOICE, first_nearest

# A point is pulled inside when it lies nearer to the surface than this fraction of the flesh's half thickness there.
SHALLOW = 0.2
# Steps in which a ball shrinks until it fits; most fit after five.
SHRINKING_STEPS = 20
# Directions of rays, none along an axis, so that they meet no edges of modelled shapes.
RAYS = np.array([[0.05, 0.03, 1.0], [1.0, -0.04, 0.07], [-0.06, 1.0, 0.02]])


@dataclass(frozen=True, eq=False)
class Interior:
    """A surface seen from inside.

    Attributes
    ----------
    points, normals : (n, 3) float64
        Vertices that are used, and outward unit normals.
    corners : (T, 3, 3) float64
        The triangles.
    """

    points: Floats
    normals: Floats
    corners: Floats

    @classmethod
    def of(cls, surface: Surface) -> "Interior":
        """Return the inside of a surface whose triangles may be wound either way."""
        mesh = surface.mesh
        wrong = wrongly_wound(mesh)
        triangles = np.where(wrong[:, None], mesh.triangles[:, ::-1], mesh.triangles)
        used = np.unique(triangles)
        corners = mesh.vertices[triangles]
        normals = vertex_normals(triangles, area_vectors(mesh.vertices[triangles]), len(mesh.vertices))
        return cls(mesh.vertices[used], normals[used], corners)

    def centred(self, points: Floats, radius: Floats) -> Floats:
        """Return points (p, 3), those outside or close under the surface pulled into the middle between its sides.

        No deeper than ``radius`` (p,), which also keeps them inside where the surface is open.
        """
        tree = cKDTree(self.points)
        skin = first_nearest(tree, points)
        offset = points - self.points[skin]
        distance = np.linalg.norm(offset, axis=1)
        # A point within a flat side is not behind it.
        is_behind = np.einsum("pj,pj->p", offset, self.normals[skin]) < -CHOICE * distance
        depth = np.where(is_behind, distance, -distance)
        centre, fitting = self._fitting_balls(tree, skin, radius)
        return np.where((depth < SHALLOW * fitting)[:, None], centre, points)

    def pulled_inside(self, points: Floats, radius: Floats) -> Floats:
        """Return points as `centred` does, and those that rays still find outside from the nearest skin inward."""
        pulled = self.centred(points, radius)
        outside = np.flatnonzero(~self.holds(pulled))
        if len(outside):
            tree = cKDTree(self.points)
            pulled[outside] = self._fitting_balls(tree, first_nearest(tree, pulled[outside]), radius[outside])[0]
        return pulled

    def _fitting_balls(self, tree: cKDTree, skin: Ints, largest: Floats) -> tuple[Floats, Floats]:
        """Return the largest balls that touch the surface from inside at given vertices and hold no others.

        References
        ----------
        .. [1] Ma, Bae, Choi, "3D medial axis point approximation using nearest neighbors and the normal field",
           The Visual Computer 2012.
        """
        touching, inward = self.points[skin], -self.normals[skin]
        radius = np.minimum(largest, np.ptp(self.points, axis=0).max() / 2)
        for _ in range(SHRINKING_STEPS):
            centre = touching + radius[:, None] * inward
            distance, other = tree.query(centre)
            across = self.points[other] - touching
            height = 2 * np.einsum("pj,pj->p", across, inward)
            smaller = np.einsum("pj,pj->p", across, across) / np.maximum(height, np.finfo(float).tiny)
            shrinks = (distance < 0.999 * radius) & (height > 0)
            if not shrinks.any():
                break
            radius = np.where(shrinks, np.minimum(smaller, radius), radius)
        return touching + radius[:, None] * inward, radius

    def holds(self, points: Floats) -> Bools:
        """Return (p,) the mask of the points inside, by the crossings of three rays each; two of them decide."""
        return np.sum([shadow.crossings(points) % 2 for shadow in self._shadows], axis=0) >= 2

    @cached_property
    def _shadows(self) -> list["_Shadow"]:
        return [_Shadow.along(self.corners, ray) for ray in RAYS]


@dataclass(frozen=True, eq=False)
class _Shadow:
    """Triangles seen along a direction.

    Attributes
    ----------
    frame : (3, 3) float64
        The direction in its last row, two across it before.
    corners : (T, 3, 3) float64
        In that frame.
    low, high : (3, T) float64
        Bounds of each triangle.
    """

    frame: Floats
    corners: Floats
    low: Floats
    high: Floats

    @classmethod
    def along(cls, corners: Floats, ray: Floats) -> "_Shadow":
        side = np.cross(ray, [0.3, 0.8, 0.5])
        frame = np.stack([side, np.cross(ray, side), ray])
        seen = corners @ frame.T
        first, second, third = np.ascontiguousarray(seen.transpose(1, 2, 0))
        low = np.minimum(np.minimum(first, second), third)
        return cls(frame, seen, low, np.maximum(np.maximum(first, second), third))

    def crossings(self, points: Floats) -> Ints:
        """Return (p,) the number of triangles that the ray from each point meets."""
        counts = []
        for x, y, z in points @ self.frame.T:
            near = np.flatnonzero((self.low[0] <= x) & (x <= self.high[0]))
            near = near[(self.low[1, near] <= y) & (y <= self.high[1, near]) & (self.high[2, near] >= z)]
            counts.append(_n_above(self.corners[near], np.array([x, y]), z))
        return np.array(counts, dtype=np.int64)


def _n_above(corners: Floats, place: Floats, height: float) -> int:
    """Return the number of triangles straight above a point, the third coordinate being up."""
    flat = corners[:, :, :2] - place
    weights = np.stack([_turn(flat[:, k - 2], flat[:, k - 1]) for k in range(3)], axis=1)
    around = (weights > 0).all(axis=1) | (weights < 0).all(axis=1)
    weights, corners = weights[around], corners[around]
    level = np.einsum("tk,tk->t", weights, corners[:, :, 2]) / weights.sum(axis=1)
    return int((level > height).sum())


def _turn(first: Floats, second: Floats) -> Floats:
    return first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
