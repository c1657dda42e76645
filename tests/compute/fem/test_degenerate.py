"""One basis, whatever the solver gave."""

import numpy as np
import pytest

from compute.fem.degenerate import fixed_basis
from compute.fem.eigenbasis import solve_eigenbasis
from tests.shapes import icosphere


@pytest.fixture(scope="module")
def sphere():
    return solve_eigenbasis(icosphere(2), 8, order=1)


def fixed(basis, functions, values):
    return fixed_basis(values, functions, basis.mass, basis.nodes)


def test_a_function_and_its_negative_are_one(sphere):
    functions = sphere.functions[:, :1] + 0.3 * sphere.functions[:, :1] ** 2
    one, other = (fixed(sphere, sign * functions, sphere.values[:1]) for sign in (1, -1))
    np.testing.assert_array_equal(one, other)
    assert (sphere.mass @ one[:, 0]) @ one[:, 0] ** 2 > 0


def test_any_basis_of_an_eigenspace_gives_the_same_one(sphere):
    """The first three functions of a sphere span the linear ones."""
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    values = np.full(3, sphere.values[0])
    one, other = (fixed(sphere, sphere.functions[:, :3] @ matrix, values) for matrix in (np.eye(3), turn))
    np.testing.assert_allclose(one, other, atol=1e-9)
    np.testing.assert_allclose(one.T @ sphere.mass @ one, np.eye(3), atol=1e-9)
    np.testing.assert_allclose(one @ one.T, sphere.functions[:, :3] @ sphere.functions[:, :3].T, atol=1e-9)


def test_functions_of_different_eigenvalues_are_not_mixed(sphere):
    odd = sphere.functions[:, [0, 4]]
    result = fixed(sphere, odd, np.array([2.0, 6.0]))
    np.testing.assert_allclose(np.abs(result), np.abs(odd))
