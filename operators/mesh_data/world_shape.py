"""The shape of an object as it stands in the world: its mesh as scales, mirrors and shears of the object leave it.

Turning and moving change no shape, and size alone changes no parts. So what is left of the matrix of an object is a
stretch that keeps the volume: shapes are its mesh stretched, in the size of the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, cast

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ..messages.user_errors import Refusal

# A stretch nearer to none than this is none. Matrices of 32 bits are turned with an error of 1e-6 under a hundred
# parents; what a hundred thousandth more would change, nobody sees.
ROUNDING = 1e-5
# An extent that is this fraction of another one is nothing but rounding.
FLAT = 1e-6
# Parents of these kinds move with single vertices or bones, which Blender alone knows.
MOVED_BY_PIECES = ("BONE", "VERTEX", "VERTEX_3")

FLATTENED = "The object is scaled to nothing along a direction, by its own scale or that of a parent; change it first."


@dataclass(frozen=True, eq=False)
class Stretch:
    """A linear map from a mesh to its shape in the world.

    Attributes
    ----------
    matrix : (3, 3) float64
        Symmetric, with a mirror across axes behind it if the object is mirrored; its determinant is 1 or -1.
    """

    matrix: NDArray[np.float64]

    @cached_property
    def is_none(self) -> bool:
        """Whether the mesh already is the shape."""
        return np.array_equal(self.matrix, np.eye(3))

    @cached_property
    def mirrors(self) -> bool:
        """Whether left and right are exchanged, and faces turned over."""
        return bool(np.linalg.det(self.matrix) < 0)

    @property
    def inverse(self) -> Stretch:
        """The map from the shape to the mesh."""
        return self if self.is_none else Stretch(np.linalg.inv(self.matrix))

    @property
    def as_transform(self) -> Matrix:
        """The map as a matrix of Blender."""
        return Matrix(self.matrix.tolist()).to_4x4()

    def of(self, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points or directions (n, 3) stretched."""
        return vectors if self.is_none else vectors @ self.matrix.T

    def turned(self, corners: NDArray[Any]) -> NDArray[Any]:
        """Return the corners (T, 3) of triangles in the order in which they face outward."""
        return corners[:, [0, 2, 1]] if self.mirrors else corners

    def areas(self, areas: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the (n,) areas of faces with unit normals (n, 3) after they are stretched."""
        return areas if self.is_none else areas * np.linalg.norm(self.inverse.matrix.T @ normals.T, axis=0)

    def agrees_with(self, other: Stretch) -> bool:
        """Whether two stretches make the same shape of every mesh, up to rounding."""
        between = self.matrix @ np.linalg.inv(other.matrix)
        is_turn = np.abs(np.linalg.svd(between, compute_uv=False) - 1).max() <= ROUNDING
        return self.mirrors == other.mirrors and bool(is_turn)


NO_STRETCH = Stretch(np.eye(3))


def stretch_of(obj: bpy.types.Object) -> Stretch:
    """Return the stretch of an object in the world.

    Raises
    ------
    Refusal
        If nothing is left of it along some direction.
    """
    matrix = _linear_part(obj)
    if not np.isfinite(matrix).all():
        raise Refusal(FLATTENED)
    # Whatever turns, the symmetric factor of the polar decomposition stays.
    _, extents, axes = np.linalg.svd(matrix)
    if extents[2] <= FLAT * extents[0]:
        raise Refusal(FLATTENED)
    extents = extents / np.cbrt(extents.prod())
    symmetric = np.eye(3) if np.ptp(extents) <= ROUNDING else axes.T @ np.diag(extents) @ axes
    return Stretch(_mirror(obj) @ symmetric if np.linalg.det(matrix) < 0 else symmetric)


def size_of(obj: bpy.types.Object) -> float:
    """Return how many units of the world one unit of the shape of an object is."""
    return float(np.cbrt(abs(np.linalg.det(_linear_part(obj)))))


def world_matrix(obj: bpy.types.Object) -> Matrix:
    """Return the matrix of an object in the world, also where Blender has not computed it.

    What is hidden, excluded or in another scene keeps the matrix of an earlier time.
    """
    parent = obj.parent
    if any(not constraint.mute for constraint in obj.constraints) or (parent and obj.parent_type in MOVED_BY_PIECES):
        return obj.matrix_world
    return obj.matrix_basis if parent is None else world_matrix(parent) @ obj.matrix_parent_inverse @ obj.matrix_basis


def users_of(mesh: bpy.types.Mesh) -> list[bpy.types.Object]:
    """Return the objects that use a mesh."""
    return [obj for obj in bpy.data.objects if obj.data == mesh] if mesh.users else []


def stands_as(obj: bpy.types.Object, stretch: Stretch) -> bool:
    """Whether an object has a stretch."""
    try:
        return stretch_of(obj).agrees_with(stretch)
    except Refusal:
        return False


def _mirror(obj: bpy.types.Object) -> NDArray[np.float64]:
    """Return a mirror that is left of a matrix that mirrors, whatever turns: across the axes with a negative scale.

    Any other mirror gives the same shape turned, but what is left and right there is read off the axes.
    """
    signs, owner = np.ones(3), cast("bpy.types.Object | None", obj)
    while owner is not None:
        signs, owner = signs * np.where(np.array(owner.scale) < 0, -1, 1), owner.parent
    return np.diag(signs if signs.prod() < 0 else [-1.0, 1.0, 1.0])


def _linear_part(obj: bpy.types.Object) -> NDArray[np.float64]:
    return np.array(world_matrix(obj).to_3x3(), dtype=np.float64)
