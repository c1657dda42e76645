"""Numbering, stiffness and mass on whole meshes."""

import numpy as np
import pytest

from compute.fem.assembly import AREA_FLOOR, mass_matrix, stiffness_matrix
from compute.fem.space import function_space
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, rectangle, tetrahedron

orders = pytest.mark.parametrize("order", [1, 2, 3])


@orders
def test_neighbours_share_the_nodes_of_their_edge(order):
    """Every node has one position, whichever triangle it is looked at from."""
    mesh = icosphere(1)
    space = function_space(mesh, order)
    from_triangles = space.element.barycentric @ mesh.vertices[mesh.triangles]
    np.testing.assert_allclose(space.nodes[space.elements], from_triangles, atol=1e-14)
    assert len(np.unique(space.nodes.round(9), axis=0)) == space.n_unknowns


@orders
def test_the_energy_of_a_coordinate_on_a_flat_patch_is_its_area(order):
    space = function_space(rectangle(4, 3, width=2.0, height=1.0), order)
    x = space.nodes[:, 0]
    assert x @ stiffness_matrix(space) @ x == pytest.approx(2.0)


@orders
def test_mass_integrates_polynomials_exactly(order):
    """The integral of x² over the rectangle [0, 2] x [0, 1] is 8/3; its area, 2, is the unit."""
    space = function_space(rectangle(4, 3), order)
    x = space.nodes[:, 0]
    ones = np.ones_like(x)
    assert ones @ mass_matrix(space) @ (x if order == 1 else x**2) * 2 == pytest.approx(2.0 if order == 1 else 8 / 3)


@orders
def test_agrees_with_scikit_fem_on_a_flat_mesh(order):
    skfem = pytest.importorskip("skfem")
    from skfem.models.poisson import laplace, mass

    mesh = rectangle(5, 3)
    element = [skfem.ElementTriP1, skfem.ElementTriP2, skfem.ElementTriP3][order - 1]()
    basis = skfem.Basis(skfem.MeshTri(mesh.vertices[:, :2].T, mesh.triangles.T), element, intorder=2 * order)
    space = function_space(mesh, order)
    _, ours, theirs = _same_places(space.nodes[:, :2], basis.doflocs.T)
    for own, other in ((stiffness_matrix(space), laplace), (mass_matrix(space) * 2.0, mass)):
        expected = other.assemble(basis).toarray()[np.ix_(theirs, theirs)]
        np.testing.assert_allclose(own.toarray()[np.ix_(ours, ours)], expected, atol=1e-13)


def _same_places(first, second):
    """Return the places that two lists hold in different order, and the order of each."""
    of_first, of_second = (np.lexsort(places.round(9).T) for places in (first, second))
    np.testing.assert_allclose(first[of_first], second[of_second], atol=1e-12)
    return first[of_first], of_first, of_second


def test_linear_elements_agree_with_lapy():
    solver = pytest.importorskip("lapy")
    mesh = icosphere(2)
    theirs = solver.Solver(solver.TriaMesh(mesh.vertices, mesh.triangles.astype(np.int32)))
    space = function_space(mesh, 1)
    np.testing.assert_allclose(stiffness_matrix(space).toarray(), theirs.stiffness.toarray(), atol=1e-12)
    np.testing.assert_allclose(mass_matrix(space).toarray() * mesh.areas.sum(), theirs.mass.toarray(), atol=1e-12)


@orders
def test_slivers_leave_the_stiffness_symmetric_and_semidefinite(order):
    """A vertex moved onto the opposite edge makes triangles without area."""
    mesh = tetrahedron(1)
    vertices = mesh.vertices.copy()
    vertices[4] = vertices[0]
    matrix = stiffness_matrix(function_space(TriangleMesh(vertices, mesh.triangles), order)).toarray()
    values = np.linalg.eigvalsh(matrix)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-6)
    np.testing.assert_allclose(matrix.sum(axis=1), 0, atol=1e-10 / AREA_FLOOR)
    assert values.min() > -1e-10 * values.max()


def test_boundary_unknowns_are_those_on_the_rim():
    space = function_space(rectangle(4, 3, width=2.0, height=1.0), 3)
    x, y, _ = space.nodes.T
    on_rim = np.isclose(x, 0) | np.isclose(x, 2) | np.isclose(y, 0) | np.isclose(y, 1)
    np.testing.assert_array_equal(space.on_boundary, on_rim)
