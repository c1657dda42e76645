"""The shape of an object as it stands in the world: its mesh as scales, mirrors and shears of the object leave it.

Turning and moving change no shape, and size alone changes no parts. So what is left of the matrix of an object is a
stretch that keeps the volume: shapes are its mesh stretched, in the size of the mesh.
"""

from __future__ import annotations

from typing import cast

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ...tasks.mesh_shape import ROUNDING, Stretch
from ...tasks.refusals import Refusal

# An extent that is this fraction of another one is nothing but rounding.
FLAT = 1e-6
# Parents of these kinds move with single vertices or bones, which Blender alone knows.
MOVED_BY_PIECES = ("BONE", "VERTEX", "VERTEX_3")

FLATTENED = "The object is scaled to nothing along a direction, by its own scale or that of a parent; change it first."


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


def as_transform(stretch: Stretch) -> Matrix:
    """Return a stretch as a matrix of Blender."""
    return Matrix(stretch.matrix.tolist()).to_4x4()


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
