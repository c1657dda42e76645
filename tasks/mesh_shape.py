"""The shape of a mesh as it stands in the world, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

# A stretch nearer to none than this is none. Matrices of 32 bits are turned with an error of 1e-6 under a hundred
# parents; what a hundred thousandth more would change, nobody sees.
ROUNDING = 1e-5


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


@dataclass(frozen=True, eq=False)
class MeshArrays:
    """The surface of a Blender mesh; V vertices, T triangles, E edges.

    Attributes
    ----------
    vertices : (V, 3) float64
        Of the shape in the world, in the size of the mesh.
    triangles : (T, 3) int64
    polygon_of_triangle : (T,) int64
    edges : (E, 2) int64
    stretch : Stretch
        From the mesh to the shape.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int64]
    polygon_of_triangle: NDArray[np.int64]
    edges: NDArray[np.int64]
    stretch: Stretch = NO_STRETCH
