"""The reference elements against the paper's table and against what polynomials must satisfy."""

import numpy as np
import pytest

from compute.errors import SpectrumError
from compute.fem.lagrange import ORDERS, reference_element

orders = pytest.mark.parametrize("order", ORDERS)


def test_cubic_integrals_are_those_of_table_1():
    """The first rows of I1 (over 80) and, for a triangle of area 1, of I4 (over 6720)."""
    element = reference_element(3)
    np.testing.assert_allclose(80 * element.dirichlet[1, 0], [34, 0, -7, 3, 3, -3, -3, 27, -54, 0], atol=1e-12)
    np.testing.assert_allclose(6720 * 2 * element.mass[0], [76, 11, 11, 18, 0, 27, 27, 0, 18, 36], atol=1e-12)


def test_linear_mass_is_a_twelfth_of_the_area_off_the_diagonal():
    np.testing.assert_allclose(reference_element(1).mass, (np.ones((3, 3)) + np.eye(3)) / 24)


@orders
def test_basis_functions_are_one_at_their_node_and_zero_at_the_others(order):
    element = reference_element(order)
    np.testing.assert_allclose(element.evaluate(element.lattice / order), np.eye(element.n_nodes), atol=1e-13)


@orders
def test_polynomials_of_the_order_are_reproduced(order):
    element = reference_element(order)
    points = np.random.default_rng(1).dirichlet(np.ones(3), 20)[:, :2]
    nodal = (1 + 2 * element.lattice[:, 0] / order - element.lattice[:, 1] / order) ** order
    np.testing.assert_allclose(element.evaluate(points) @ nodal, (1 + 2 * points[:, 0] - points[:, 1]) ** order)


@orders
def test_constants_have_no_dirichlet_energy_and_the_mass_of_the_triangle(order):
    element = reference_element(order)
    np.testing.assert_allclose(element.dirichlet.sum(axis=2), 0, atol=1e-13)
    assert element.mass.sum() == pytest.approx(0.5)


@orders
def test_the_subdivision_tiles_the_triangle_and_keeps_its_winding(order):
    element = reference_element(order)
    a, b, c = (element.lattice / order)[element.subdivision].swapaxes(0, 1)
    doubled_areas = np.linalg.det(np.stack([b - a, c - a], axis=1))
    np.testing.assert_allclose(doubled_areas, np.full(order**2, 1 / order**2))


def test_other_orders_are_refused():
    with pytest.raises(SpectrumError, match="order 4"):
        reference_element(4)
