"""The order of elimination: complete, nested, and sparser than what the factorization finds by itself."""

import numpy as np
import pytest
from scipy.sparse.linalg import splu

from compute.fem.eigensolver import eigen_problem
from compute.fem.nested_dissection import LEAF_TRIANGLES, LEAST_SHARE, bisect_triangles, elimination_order
from compute.fem.shift_invert import SHIFT
from compute.fem.space import function_space
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, star, torus


def problem_on(mesh):
    space = function_space(mesh, 3)
    return eigen_problem(space, space.has_mass)


def test_every_unknown_is_eliminated_once():
    space = function_space(torus(12, 9), 3)
    order = elimination_order(space.elements, bisect_triangles(space.mesh), space.n_unknowns)
    assert sorted(order) == list(range(space.n_unknowns))


@pytest.mark.parametrize("mesh", [icosphere(3), star(n_subdivisions=3), torus(40, 30)], ids=["sphere", "star", "torus"])
def test_halves_are_balanced_down_to_small_leaves(mesh):
    codes = bisect_triangles(mesh)
    depth = int(codes.max()).bit_length()
    upper = (codes >> (depth - 1)).mean()
    assert LEAST_SHARE / 2 <= upper <= 1 - LEAST_SHARE / 2
    assert np.unique(codes, return_counts=True)[1].max() <= LEAF_TRIANGLES


def test_unknowns_of_two_halves_meet_only_in_the_separator():
    """Eliminated last, the separator comes after everything that lies in one half alone."""
    mesh = icosphere(3)
    space, codes = function_space(mesh, 3), bisect_triangles(mesh)
    half = codes >> (int(codes.max()).bit_length() - 1)
    sides = [np.unique(space.elements[half == side]) for side in (0, 1)]
    separator = np.intersect1d(*sides)
    order = elimination_order(space.elements, codes, space.n_unknowns)
    assert set(order[-len(separator) :]) == set(separator)
    assert len(separator) < 0.1 * space.n_unknowns


@pytest.mark.parametrize(
    ("mesh", "share"), [(icosphere(4), 0.5), (star(n_subdivisions=4), 0.7)], ids=["sphere", "star"]
)
def test_factors_are_sparser_than_in_the_default_order(mesh, share):
    problem = problem_on(mesh)
    stiffness, mass = problem.matrices(problem.elimination_order)
    default = splu((stiffness - SHIFT * mass).tocsc())
    assert problem.factored(stiffness, mass).nnz <= share * default.nnz


@pytest.mark.parametrize("n_copies", [1, 2, 9, 100])
def test_triangles_in_one_place_are_ordered_all_the_same(n_copies):
    """Centres without extent leave no direction to cut along."""
    mesh = TriangleMesh(np.eye(3), np.tile([0, 1, 2], (n_copies, 1)))
    assert np.unique(bisect_triangles(mesh), return_counts=True)[1].max() <= LEAF_TRIANGLES
