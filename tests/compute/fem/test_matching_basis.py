"""Functions that shapes are matched by."""

from dataclasses import replace

import numpy as np
import pytest

from compute.fem.eigenbasis import solve_on_surface
from compute.fem.matching_basis import MATCHING_FUNCTIONS, MATCHING_UNKNOWNS, solve_for_matching
from compute.progress import silent
from compute.surface.cleaning import clean_surface
from tests.shapes import icosphere, rectangle, star


@pytest.mark.parametrize(("n_long", "n_short", "order"), [(12, 8, 3), (30, 25, 2), (60, 50, 1)])
def test_coarse_meshes_have_elements_of_a_higher_order(n_long, n_short, order):
    basis = solve_for_matching(clean_surface(rectangle(n_long, n_short)), None, silent)
    assert (basis.order, basis.boundary, len(basis.values)) == (order, "neumann", MATCHING_FUNCTIONS)
    assert len(basis.nodes) == (order * n_long + 1) * (order * n_short + 1)
    assert order == 3 or len(basis.nodes) >= MATCHING_UNKNOWNS


def test_a_mesh_with_few_unknowns_has_fewer_functions():
    surface = clean_surface(icosphere(0))
    assert len(solve_for_matching(surface, None, silent).values) == len(solve_on_surface(surface, 5).nodes) - 1


def test_functions_point_where_the_shown_ones_do():
    surface = clean_surface(star(3, n_subdivisions=2))
    shown = solve_on_surface(surface, 5)
    n_vertices = len(surface.vertex_of_input)
    for sign in (1, -1):
        basis = solve_for_matching(surface, replace(shown, functions=sign * shown.functions), silent)
        products = (basis.functions[:n_vertices, :5] * sign * shown.functions[:n_vertices]).sum(axis=0)
        assert (products > 0).all()
    held = replace(shown, boundary="dirichlet")
    np.testing.assert_array_equal(
        solve_for_matching(surface, held, silent).functions, solve_for_matching(surface, None, silent).functions
    )
