"""Points on a surface of triangles, and the nearest of them that look the same way as a given place."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...surface.mesh import Bools, Floats, Ints, area_vectors, unit_rows

# A triangle is found by several places on it where it is large: one for each piece of this many median sides.
MEDIAN_SIDES = 2.0
MOST_PIECES = 12
# Distance, on a surface of area 1, that an inner wall instead of an outer one counts as, or the other way round.
OTHER_WALL = 0.02
# Below this cosine between two normals a point is on another side, such as the back of a thin ear or the lip below.
SAME_SIDE = 0.3


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on triangles; n points.

    Attributes
    ----------
    triangles : (n,) int64
    barycentric : (n, 3) float64
        Sum to 1.
    """

    triangles: Ints
    barycentric: Floats

    def blend(self, values: Floats, triangles: Ints) -> Floats:
        """Return (n, ...) values (V, ...) of the vertices of ``triangles`` (T, 3) at the points."""
        return np.einsum("nk,nk...->n...", self.barycentric, values[triangles[self.triangles]])


class SurfaceTree:
    """Finds the nearest points of a surface that look the same way.

    Parameters
    ----------
    positions : (V, 3) float64
    triangles : (T, 3) int64
        Wound consistently.
    turn : float
        Distance that a turn of the normal by one radian counts as when candidates are gathered.
    wrong_side : float
        Distance that a normal of the other side counts as when one of them is chosen.
    is_inner : (T,) bool, optional
        Triangles that are inner walls; none if left out.
    """

    def __init__(
        self, positions: Floats, triangles: Ints, turn: float, wrong_side: float, is_inner: Bools | None = None
    ) -> None:
        self._corners = positions[triangles]
        self._normals = unit_rows(area_vectors(self._corners))
        self._turn, self._wrong_side = turn, wrong_side
        self._is_inner = np.zeros(len(triangles), dtype=bool) if is_inner is None else is_inner
        places, self._triangle_of_place = _places(self._corners)
        self._tree = cKDTree(self._keys(places, self._normals, self._is_inner, self._triangle_of_place))

    def _keys(self, places: Floats, normals: Floats, is_inner: Bools, row: Ints | slice = slice(None)) -> Floats:
        """Return (n, 7) points of the space in which places that look alike are near."""
        return np.hstack([places, self._turn * normals[row], OTHER_WALL * is_inner[row, None]])

    def nearest(
        self, points: Floats, normals: Floats, n_candidates: int, is_inner: Bools | None = None
    ) -> tuple[SurfacePoints, Floats]:
        """Return the nearest point to each of (n, 3) points with unit normals, and (n,) its distance.

        An inner wall is sought for points that are on one (n,), an outer wall for all others.
        """
        n_candidates = min(n_candidates, len(self._triangle_of_place))
        is_inner = np.zeros(len(points), dtype=bool) if is_inner is None else is_inner
        place = self._tree.query(self._keys(points, normals, is_inner), n_candidates)[1].reshape(len(points), -1)
        triangle = self._triangle_of_place[place]
        rows = np.repeat(points, n_candidates, axis=0)
        barycentric, distance = nearest_in_triangles(rows, self._corners[triangle.ravel()])
        cosine = np.einsum("nkj,nj->nk", self._normals[triangle], normals)
        cost = distance.reshape(triangle.shape) ** 2 + (self._wrong_side * np.maximum(SAME_SIDE - cosine, 0)) ** 2
        cost += OTHER_WALL**2 * (self._is_inner[triangle] != is_inner[:, None])
        best = np.arange(len(points)), cost.argmin(axis=1)
        nearest = SurfacePoints(triangle[best], barycentric.reshape(*triangle.shape, 3)[best])
        return nearest, distance.reshape(triangle.shape)[best]


def nearest_in_triangles(points: Floats, corners: Floats) -> tuple[Floats, Floats]:
    """Return (n, 3) barycentric coordinates of the nearest point of each triangle (n, 3, 3), and (n,) the distances."""
    barycentric = plane_coordinates(points, corners)
    outside = np.flatnonzero((barycentric < 0).any(axis=1))
    if len(outside):
        barycentric[outside] = _nearest_on_sides(points[outside], corners[outside])
    return barycentric, np.linalg.norm(np.einsum("nk,nkj->nj", barycentric, corners) - points, axis=1)


def plane_coordinates(points: Floats, corners: Floats) -> Floats:
    """Return (n, 3) barycentric coordinates of points in the planes of triangles; negative ones for flat triangles."""
    a, b, c = corners.swapaxes(0, 1)
    u, v, w = b - a, c - a, points - a
    uu, uv, vv, wu, wv = (np.einsum("ij,ij->i", x, y) for x, y in ((u, u), (u, v), (v, v), (w, u), (w, v)))
    determinant = uu * vv - uv * uv
    is_flat = determinant <= 1e-14 * uu * vv
    determinant = np.where(is_flat, 1.0, determinant)
    second, third = (vv * wu - uv * wv) / determinant, (uu * wv - uv * wu) / determinant
    coordinates = np.stack([1 - second - third, second, third], axis=1)
    coordinates[is_flat] = -1.0
    return coordinates


def _nearest_on_sides(points: Floats, corners: Floats) -> Floats:
    candidates = np.stack([_on_side(points, corners, side) for side in range(3)], axis=1)
    away = np.einsum("nsk,nkj->nsj", candidates, corners) - points[:, None]
    nearest = np.einsum("nsj,nsj->ns", away, away).argmin(axis=1)
    return candidates[np.arange(len(points)), nearest]


def _on_side(points: Floats, corners: Floats, side: int) -> Floats:
    start, stop = corners[:, side], corners[:, (side + 1) % 3]
    along = stop - start
    squared = np.maximum(np.einsum("ij,ij->i", along, along), np.finfo(float).tiny)
    place = np.clip(np.einsum("ij,ij->i", points - start, along) / squared, 0, 1)
    coordinates = np.zeros((len(points), 3))
    coordinates[:, side], coordinates[:, (side + 1) % 3] = 1 - place, place
    return coordinates


def _places(corners: Floats) -> tuple[Floats, Ints]:
    """Return places on triangles, more of them on large ones, and the triangle of each."""
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    step = max(MEDIAN_SIDES * float(np.median(sides)), np.finfo(float).tiny)
    pieces = np.clip(np.ceil(sides / step), 1, MOST_PIECES).astype(np.int64)
    places, triangles = [], []
    for n in np.unique(pieces).tolist():
        chosen = np.flatnonzero(pieces == n)
        lattice = _lattice(n)
        places.append(np.einsum("lk,tkj->tlj", lattice, corners[chosen]).reshape(-1, 3))
        triangles.append(np.repeat(chosen, len(lattice)))
    return np.concatenate(places), np.concatenate(triangles)


def _lattice(n: int) -> Floats:
    """Return barycentric coordinates of the middles of the upright triangles of n rows."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    i, j = i[i + j < n], j[i + j < n]
    return (np.stack([i, j, n - 1 - i - j], axis=1) + 1 / 3) / n
