"""Finite element spaces on a triangle mesh: the unknowns of each triangle."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..surface.mesh import Bools, Floats, Ints, TriangleMesh
from .lagrange import ReferenceElement, reference_element


@dataclass(frozen=True, eq=False)
class FunctionSpace:
    """Continuous functions that are polynomials on each triangle.

    Attributes
    ----------
    mesh : TriangleMesh
        V vertices, used or not, T triangles.
    element : ReferenceElement
        The polynomials on one triangle, by n nodal values.
    elements : (T, n) int64
        Unknowns of each triangle in the node order of the element. Unknowns 0 to V-1 are the vertices of the mesh;
        those inside edges follow, from the lower vertex to the higher; then those inside triangles.
    """

    mesh: TriangleMesh
    element: ReferenceElement
    elements: Ints

    @property
    def n_unknowns(self) -> int:
        """Number of unknowns N, those of unused vertices included."""
        inside_edges = len(self.mesh.edges.vertices) * self.element.n_inside_edge
        return len(self.mesh.vertices) + inside_edges + len(self.elements) * self.element.n_interior

    @cached_property
    def nodes(self) -> Floats:
        """(N, 3) position of each unknown."""
        nodes = np.empty((self.n_unknowns, 3))
        corners = self.mesh.vertices[self.mesh.triangles]
        nodes[self.elements] = self.element.barycentric @ corners
        nodes[: len(self.mesh.vertices)] = self.mesh.vertices
        return nodes

    @cached_property
    def has_mass(self) -> Bools:
        """(N,) whether any triangle uses the unknown."""
        used = np.zeros(self.n_unknowns, dtype=bool)
        used[self.elements] = True
        return used

    @cached_property
    def on_boundary(self) -> Bools:
        """(N,) whether the unknown lies on an edge of a single triangle."""
        # The nodes of edge k are its ends k, k + 1 and the run of nodes inside it.
        n_inside = self.element.n_inside_edge
        on_boundary = np.zeros(self.n_unknowns, dtype=bool)
        is_border = self.mesh.edges.n_triangles[self.mesh.edges.of_triangle] == 1
        for k in range(3):
            local = [k, (k + 1) % 3, *range(3 + k * n_inside, 3 + (k + 1) * n_inside)]
            on_boundary[self.elements[is_border[:, k]][:, local]] = True
        return on_boundary


def function_space(mesh: TriangleMesh, order: int) -> FunctionSpace:
    """Return the continuous functions on a mesh that are polynomials of an order on each triangle.

    Parameters
    ----------
    mesh : TriangleMesh
    order : int
        1, 2 or 3.

    Raises
    ------
    SpectrumError
        If the order is not 1, 2 or 3.
    """
    element = reference_element(order)
    n_vertices, n_triangles = len(mesh.vertices), len(mesh.triangles)
    first_interior = n_vertices + element.n_inside_edge * len(mesh.edges.vertices)
    interior = first_interior + np.arange(n_triangles * element.n_interior).reshape(n_triangles, -1)
    return FunctionSpace(mesh, element, np.hstack([mesh.triangles, _edge_unknowns(mesh, element), interior]))


def _edge_unknowns(mesh: TriangleMesh, element: ReferenceElement) -> Ints:
    """Return the unknowns inside the three edges of each triangle, each edge in the triangle's direction."""
    inside = np.arange(element.n_inside_edge)
    is_backward = mesh.triangles > np.roll(mesh.triangles, -1, axis=1)
    along = np.where(is_backward[:, :, None], inside[::-1], inside)
    first = len(mesh.vertices) + element.n_inside_edge * mesh.edges.of_triangle
    return (first[:, :, None] + along).reshape(len(mesh.triangles), -1)
