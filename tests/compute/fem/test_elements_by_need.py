"""Linear elements where their error is small, cubic ones elsewhere, and the estimate by which they are chosen."""

from functools import cache, partial

import numpy as np
import pytest

from compute.analysis.analyze import analyze
from compute.fem import elements_by_need
from compute.fem.assembly import metric
from compute.fem.eigenbasis import solve_eigenbasis
from compute.fem.eigensolver import EigenProblem
from compute.fem.elements_by_need import LEAST_VERTICES
from compute.fem.linear_error import relative_excess
from compute.fem.order_choice import choose_order, memory_of_functions, n_unknowns
from compute.fem.space import function_space
from compute.surface.mesh import TriangleMesh
from examples import humanoid
from tests.shapes import icosphere, joined, rectangle, star


def bumpy(mesh):
    x, y, z = mesh.vertices.T
    return TriangleMesh(mesh.vertices * (1 + 0.2 * np.sin(3 * x) * np.cos(2 * y + z))[:, None], mesh.triangles)


def estimated(mesh, basis):
    space, area = function_space(mesh, 1), mesh.areas.sum()
    is_free = space.has_mass if basis.boundary == "neumann" else ~space.on_boundary
    problem = EigenProblem(space, is_free, metric(mesh), None)
    return relative_excess(problem, basis.values * area, basis.functions * np.sqrt(area))


@pytest.mark.parametrize(
    ("mesh", "boundary"),
    [
        (bumpy(icosphere(3)), "neumann"),
        (rectangle(20, 30, width=1.0, height=1.3), "neumann"),
        (rectangle(20, 30, width=1.0, height=1.3), "dirichlet"),
    ],
)
def test_the_estimate_is_near_what_quadratic_elements_gain(mesh, boundary):
    linear, quadratic = (solve_eigenbasis(mesh, 8, order=order, boundary=boundary) for order in (1, 2))
    gain = linear.values / quadratic.values - 1
    estimate = estimated(mesh, linear)
    assert estimate.max() == pytest.approx(gain.max(), rel=0.2)
    assert np.all((estimate > 0.4 * gain) & (estimate < 1.5 * gain))


def test_the_estimate_falls_with_the_square_of_the_edges():
    coarse, fine = (estimated(mesh, solve_eigenbasis(mesh, 6, order=1)) for mesh in (icosphere(3), icosphere(4)))
    np.testing.assert_allclose(coarse / fine, 4, rtol=0.05)


def test_the_estimate_does_not_depend_on_scale_and_numbering():
    mesh = bumpy(icosphere(3))
    order = np.random.default_rng(0).permutation(len(mesh.vertices))
    other = TriangleMesh(1000 * mesh.vertices[order], np.argsort(order)[mesh.triangles])
    first, second = (estimated(m, solve_eigenbasis(m, 6, order=1)) for m in (mesh, other))
    np.testing.assert_allclose(first, second, rtol=1e-6)


@cache
def body(n_vertices):
    character = humanoid(n_vertices)
    return TriangleMesh(character.vertices, character.triangles)


def test_a_fine_body_gets_linear_elements_and_a_coarse_one_cubic_ones():
    fine, coarse = analyze(body(10_000), field=1), analyze(body(4000))
    assert (fine.order, coarse.order) == (1, 3)
    assert len(coarse.surface.mesh.used) > LEAST_VERTICES
    assert fine.warnings == coarse.warnings == ()


def test_few_vertices_get_cubic_elements_without_a_look_at_linear_ones(monkeypatch):
    monkeypatch.setattr(elements_by_need, "linear_eigenpairs", None)
    assert analyze(star()).order == 3


def test_linear_functions_are_solved_for_once_where_cubic_ones_are_taken(monkeypatch):
    """Those by which the order is chosen are the start of the cubic ones."""
    solved, solve = [], elements_by_need.linear_eigenpairs
    monkeypatch.setattr(elements_by_need, "linear_eigenpairs", lambda *a: solved.append(a) or solve(*a))
    monkeypatch.setattr("compute.fem.eigensolver.linear_eigenpairs", None)
    assert analyze(body(4000)).order == 3
    assert len(solved) == 1


def test_parts_by_need_are_those_of_cubic_elements():
    mesh = body(10_000)
    by_need, cubic = (analyze(mesh, order=order).segment() for order in ("auto", 3))
    assert by_need.n_parts == cubic.n_parts
    assert mesh.areas[by_need.labels == cubic.labels].sum() >= 0.995 * mesh.areas.sum()


def test_more_functions_than_linear_elements_carry_are_solved_for_with_cubic_ones():
    mesh = icosphere(2)
    assert analyze(mesh, field=1, n_functions=300).order == 3


def test_who_cannot_have_what_is_needed_is_told(monkeypatch):
    mesh = body(4000)
    budgets = [memory_of_functions(n_unknowns(mesh, 2)), 1.0]
    for budget, elements in zip(budgets, ("quadratic", "linear"), strict=True):
        monkeypatch.setattr(elements_by_need, "choose_order", partial(choose_order, memory_budget=budget))
        assert [text for text in analyze(mesh).warnings if f"{elements} elements were used instead of cubic" in text]


def test_no_order_is_told_of_values_of_ones_own():
    mesh = star()
    assert analyze(mesh, field=mesh.vertices[:, 2]).order is None


def test_shells_by_themselves_share_the_best_order_that_all_can_afford(monkeypatch):
    monkeypatch.setattr(elements_by_need, "LARGEST_EXCESS", np.inf)
    monkeypatch.setattr(elements_by_need, "LEAST_VERTICES", 0)
    first = star()
    apart = joined(first, TriangleMesh(first.vertices + 10, first.triangles))
    assert analyze(apart, shells="separate").order == 3
    assert analyze(apart, shells="largest").order == 1
