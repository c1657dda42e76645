"""Eigenpairs by way of coarser levels are those of one factor, as far as linear elements are right at all."""

from itertools import pairwise

import numpy as np
import pytest

from compute.analysis.analyze import analyze
from compute.errors import Cancelled, SpectrumError
from compute.fem import elements_by_need, multigrid, multilevel_eigenpairs
from compute.fem.eigenbasis import posed_problem, wanted_pairs
from compute.fem.eigensolver import linear_eigenpairs
from compute.progress import silent
from compute.surface.cleaning import clean_surface
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, lathe, rectangle, star

solve = multilevel_eigenpairs.multilevel_eigenpairs


@pytest.fixture(autouse=True)
def _small(monkeypatch):
    monkeypatch.setattr(multigrid, "COARSEST_UNKNOWNS", 300)
    monkeypatch.setattr(multilevel_eigenpairs, "LEAST_UNKNOWNS", 1000)
    monkeypatch.setattr(elements_by_need, "LARGEST_EXCESS", np.inf)
    monkeypatch.setattr(elements_by_need, "LEAST_VERTICES", 1000)


def bumpy(mesh):
    x, y, z = mesh.vertices.T
    return TriangleMesh(mesh.vertices * (1 + 0.2 * np.sin(3 * x) * np.cos(2 * y + z))[:, None], mesh.triangles)


def rough(mesh):
    moves = np.random.default_rng(0).standard_normal(mesh.vertices.shape)
    return TriangleMesh(mesh.vertices + 0.01 * moves, mesh.triangles)


def problem_of(mesh, boundary="neumann"):
    return posed_problem(clean_surface(mesh), 8, 1, boundary)


def assert_same_pairs(mesh, boundary="neumann", wanted=None, tolerance=1e-3):
    problem, wanted = problem_of(mesh, boundary), wanted or wanted_pairs(8, boundary, np.inf)
    values, functions = solve(problem, wanted, silent)
    expected, known = linear_eigenpairs(problem, wanted, silent)
    used = slice(wanted.n_constant, wanted.n_within(expected))
    np.testing.assert_allclose(values[used], expected[used], rtol=tolerance)
    _, mass = problem.matrices(np.arange(problem.space.n_unknowns))
    np.testing.assert_allclose(functions.T @ (mass @ functions), np.eye(len(values)), atol=1e-9)
    # What the functions of one solver leave of those of the other.
    overlap = functions.T @ (mass @ known[:, : used.stop - 1])
    assert np.all(np.linalg.norm(overlap, axis=0) > 1 - 1e-3)


@pytest.mark.parametrize("mesh", [bumpy(icosphere(4)), rough(icosphere(4)), star(), rectangle(60, 40)])
def test_the_pairs_are_those_of_one_factor(mesh):
    assert_same_pairs(mesh)


def test_functions_that_are_held_at_the_border_are_found():
    assert_same_pairs(rectangle(60, 40), "dirichlet")


def test_needles_and_thin_sheets_are_solved_like_others():
    """Triangles of 1 to 30, and the two sides of a sheet a thousandth as thick as it is wide."""
    assert_same_pairs(rectangle(30, 60, width=10.0, height=0.7))
    profile = np.array([[0.0, 0.0], *([r, 0.0] for r in np.linspace(0.05, 1, 20)), [1.001, 0.0005]])
    upper = profile[::-1].copy()
    upper[:, 1] = 0.001 - upper[:, 1]
    assert_same_pairs(lathe(np.vstack([profile, upper[1:]]), 60))


def test_only_as_many_as_are_used():
    assert_same_pairs(star(), wanted=wanted_pairs(30, "neumann", 5.0))


def test_values_do_not_depend_on_the_numbering_of_vertices():
    mesh = bumpy(icosphere(4))
    order = np.random.default_rng(0).permutation(len(mesh.vertices))
    other = TriangleMesh(mesh.vertices[order], np.argsort(order)[mesh.triangles])
    first, second = (solve(problem_of(m), wanted_pairs(8, "neumann", np.inf), silent)[0] for m in (mesh, other))
    np.testing.assert_allclose(first[1:], second[1:], rtol=1e-6)


def test_the_same_mesh_has_the_same_pairs():
    first, second = (solve(problem_of(star()), wanted_pairs(8, "neumann", np.inf), silent) for _ in range(2))
    np.testing.assert_array_equal(first[0], second[0])
    np.testing.assert_array_equal(first[1], second[1])


def test_a_smooth_mesh_takes_two_steps_on_its_own_vertices_and_no_factor_of_its_size(monkeypatch):
    steps, factored = [], []
    inverse = multigrid.Multigrid.approximate_inverse
    factor = multigrid.factored_by_columns
    monkeypatch.setattr(
        multigrid.Multigrid, "approximate_inverse", lambda grid, r: steps.append(len(r)) or inverse(grid, r)
    )
    monkeypatch.setattr(multigrid, "factored_by_columns", lambda *a: factored.append(a[0].shape[0]) or factor(*a))
    mesh = bumpy(icosphere(5))
    solve(problem_of(mesh), wanted_pairs(8, "neumann", np.inf), silent)
    assert steps.count(len(mesh.vertices)) <= 2
    assert len(factored) == 1
    assert factored[0] <= 300


def test_automatic_order_goes_by_levels_and_an_order_that_is_asked_for_does_not(monkeypatch):
    mesh, solved = star(), []
    monkeypatch.setattr(elements_by_need, "multilevel_eigenpairs", lambda *a: solved.append(a) or solve(*a))
    by_levels = analyze(mesh)
    assert len(solved) == 1
    by_factor = analyze(mesh, order=1)
    assert len(solved) == 1
    assert by_levels.order == 1
    assert mesh.areas[by_levels.segment().labels == by_factor.segment().labels].sum() > 0.995 * mesh.areas.sum()


@pytest.mark.parametrize("n_steps", [0, 1])
def test_what_does_not_converge_is_factored(monkeypatch, n_steps):
    monkeypatch.setattr(multilevel_eigenpairs, "MOST_STEPS", n_steps)
    monkeypatch.setattr(multilevel_eigenpairs, "LARGEST_ERROR", 0.0)
    mesh = star()
    with pytest.raises(SpectrumError, match="did not converge"):
        solve(problem_of(mesh), wanted_pairs(8, "neumann", np.inf), silent)
    np.testing.assert_allclose(analyze(mesh).field.values, analyze(mesh, order=1).field.values, rtol=1e-9, atol=1e-9)


def test_many_functions_are_not_for_levels():
    problem = problem_of(star())
    assert multilevel_eigenpairs.is_for_levels(problem, wanted_pairs(30, "neumann", np.inf))
    assert not multilevel_eigenpairs.is_for_levels(problem, wanted_pairs(100, "neumann", np.inf))


def test_it_tells_how_far_it_is_and_can_be_stopped():
    told = []
    solve(problem_of(star()), wanted_pairs(8, "neumann", np.inf), lambda fraction, _: told.append(fraction))
    assert all(first <= second for first, second in pairwise(told))

    def stop(fraction, _):
        if fraction > 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        solve(problem_of(star()), wanted_pairs(8, "neumann", np.inf), stop)
