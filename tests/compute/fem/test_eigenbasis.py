"""The eigenfunctions against closed forms."""

import numpy as np
import pytest

from compute.errors import EngineError
from compute.fem.eigenbasis import solve_eigenbasis
from compute.mesh import TriangleMesh
from tests.shapes import icosphere, rectangle, tetrahedron


@pytest.mark.parametrize(("order", "rate"), [(1, 2), (2, 4), (3, 6)])
def test_eigenvalues_converge_at_twice_the_order_on_a_tetrahedron(order, rate):
    """The tetrahedron with edge 1 has the eigenvalue 4 pi^2 / 3 three times."""
    coarse, fine = (solve_eigenbasis(tetrahedron(n), 3, order=order).values.mean() for n in (2, 3))
    exact = 4 * np.pi**2 / 3
    assert np.log2((coarse - exact) / (fine - exact)) == pytest.approx(rate, abs=0.1)


@pytest.mark.parametrize(("boundary", "exact"), [("neumann", [1, 4, 4, 5, 8]), ("dirichlet", [5, 8, 13, 17, 20])])
def test_rectangle_has_its_products_of_waves(boundary, exact):
    """A 2 x 1 rectangle has eigenvalues pi^2 / 4 (m^2 + 4 n^2)."""
    basis = solve_eigenbasis(rectangle(20, 10), 5, boundary=boundary)
    np.testing.assert_allclose(basis.values, np.pi**2 / 4 * np.array(exact), rtol=1e-5)


def test_sphere_has_multiplicities_3_5_7():
    values = solve_eigenbasis(icosphere(3), 15).values
    np.testing.assert_allclose(values, [2] * 3 + [6] * 5 + [12] * 7, rtol=0.01)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_functions_are_orthonormal_eigenfunctions(order):
    basis = solve_eigenbasis(icosphere(2), 8, order=order)
    np.testing.assert_allclose(basis.functions.T @ basis.mass @ basis.functions, np.eye(8), atol=1e-9)


def test_values_scale_with_the_inverse_square_of_the_length():
    mesh = icosphere(2)
    small = TriangleMesh(mesh.vertices * 1e-6, mesh.triangles)
    np.testing.assert_allclose(solve_eigenbasis(small, 8).values * 1e-12, solve_eigenbasis(mesh, 8).values, rtol=1e-9)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"order": 4}, "order 4"),
        ({"boundary": "robin"}, "robin"),
        ({"boundary": "dirichlet"}, "closed"),
        ({"n_functions": 10_000}, "carries only"),
        ({"n_functions": 0}, "at least one"),
        ({"component": 7}, "does not exist"),
    ],
)
def test_impossible_questions_are_refused_with_a_sentence(options, sentence):
    with pytest.raises(EngineError, match=sentence):
        solve_eigenbasis(tetrahedron(2), **options)
