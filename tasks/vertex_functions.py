"""Eigenfunctions of a mesh as values of its vertices."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import compute
from .mesh_shape import MeshArrays

LOOSE_PARTS = "The mesh has {} loose parts; the eigenfunctions are those of the largest, and 0 on the others."


@dataclass(frozen=True, eq=False)
class VertexFunctions:
    """Eigenfunctions as (V, k) float32 on the vertices, and what is to be told of the mesh."""

    values: NDArray[np.float32]
    warnings: tuple[str, ...]


def functions_on_vertices(arrays: MeshArrays, n_functions: int, progress: compute.Progress) -> VertexFunctions:
    """Return the smoothest functions."""
    mesh = compute.TriangleMesh(arrays.vertices, arrays.triangles)
    basis = compute.solve_eigenbasis(mesh, n_functions, progress=progress)
    values = basis.functions[: len(arrays.vertices)].astype(np.float32)
    n_parts = basis.surface.n_components
    return VertexFunctions(values, (LOOSE_PARTS.format(n_parts),) if n_parts > 1 else ())
