"""Stiffness and mass matrices of the Laplace-Beltrami operator on a triangle mesh."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array

from ..surface.mesh import Floats, Ints, TriangleMesh
from .lagrange import ReferenceElement
from .space import FunctionSpace

# Slivers: no triangle counts with less than this part of the mean area. The edge vectors stay as they are, so that
# every element's matrix remains a Gram matrix: symmetric and positive semidefinite. Clamping cotangents does not.
AREA_FLOOR = 1e-6


@dataclass(frozen=True, eq=False)
class Metric:
    """First fundamental form of each triangle, in the unit of length that makes the area of the mesh 1.

    Attributes
    ----------
    doubled_areas : (T,) float64
        Ratio of the triangle to the reference triangle, floored for slivers.
    xi, eta, mixed : (T,) float64
        Weights of the three reference Dirichlet integrals in the stiffness of the triangle.
    """

    doubled_areas: Floats
    xi: Floats
    eta: Floats
    mixed: Floats


def metric(mesh: TriangleMesh) -> Metric:
    """Return the metric of the triangles of a mesh, in units in which its area is 1."""
    total = mesh.areas.sum()
    doubled = 2 * mesh.areas / total
    doubled = np.maximum(doubled, AREA_FLOOR * doubled.mean())
    a, b, c = (mesh.vertices[mesh.triangles] / np.sqrt(total)).swapaxes(0, 1)
    first, second = b - a, c - a
    squared_first, squared_second, product = (
        np.einsum("ij,ij->i", u, v) for u, v in ((first, first), (second, second), (first, second))
    )
    return Metric(doubled, squared_second / doubled, squared_first / doubled, -product / doubled)


def element_stiffness(metric: Metric, element: ReferenceElement) -> Floats:
    """Return (T, n, n) the stiffness matrix of each triangle, which has no unit."""
    weights = np.stack([metric.xi, metric.eta, metric.mixed], axis=1)
    return np.tensordot(weights, element.dirichlet, axes=1)


def element_mass(metric: Metric, element: ReferenceElement) -> Floats:
    """Return (T, n, n) the mass matrix of each triangle, in units of the mesh's area."""
    return metric.doubled_areas[:, None, None] * element.mass


def assemble(elements: Ints, matrices: Floats, n_unknowns: int) -> csr_array:
    """Return the (N, N) sum of the (T, n, n) element matrices over their unknowns."""
    # Narrow indices make the conversion several times faster.
    elements = elements.astype(np.int32)
    n_local = elements.shape[1]
    rows = np.repeat(elements, n_local, axis=1).ravel()
    columns = np.tile(elements, (1, n_local)).ravel()
    return coo_array((matrices.ravel(), (rows, columns)), shape=(n_unknowns, n_unknowns)).tocsr()


def stiffness_matrix(space: FunctionSpace) -> csr_array:
    """Return the (N, N) integrals of the products of gradients; they do not depend on the unit of length."""
    matrices = element_stiffness(metric(space.mesh), space.element)
    return assemble(space.elements, matrices, space.n_unknowns)


def mass_matrix(space: FunctionSpace) -> csr_array:
    """Return the (N, N) integrals of the products of two basis functions, in units of the mesh's area."""
    matrices = element_mass(metric(space.mesh), space.element)
    return assemble(space.elements, matrices, space.n_unknowns)
