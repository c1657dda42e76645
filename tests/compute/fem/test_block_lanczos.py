"""The iteration on matrices that are known, and its refusal to believe a bad factor."""

from collections import Counter

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array, eye_array
from scipy.sparse.linalg import splu

from compute.errors import SpectrumError
from compute.fem import block_lanczos, eigensolver
from compute.fem.block_lanczos import Pencil, smallest_eigenpairs
from compute.fem.eigenbasis import solve_eigenbasis
from compute.progress import silent
from tests.shapes import icosphere

SHIFT = -0.01


def ring_of_springs(n):
    """Return the stiffness of n unit masses on a ring of unit springs."""
    one = np.ones(n - 1)
    ring = diags_array([2 * np.ones(n), -one, -one, [-1.0], [-1.0]], offsets=[0, 1, -1, n - 1, 1 - n])
    return csr_array(ring)


def pencil_of(stiffness, scale=1.0):
    mass = csr_array(eye_array(stiffness.shape[0]))
    factor = splu((stiffness - SHIFT * mass).tocsc())
    return Pencil(stiffness, mass, SHIFT, lambda columns: scale * factor.solve(columns))


def test_ring_of_springs():
    """A ring of n unit springs has eigenvalues 2 - 2 cos(2 pi j / n), all but the first twice."""
    start = np.random.default_rng(0).standard_normal((600, 3))
    values, functions = smallest_eigenpairs(pencil_of(ring_of_springs(600)), start, 9, 1e-6, silent)
    j = np.array([0, 1, 1, 2, 2, 3, 3, 4, 4])
    np.testing.assert_allclose(values, 2 - 2 * np.cos(2 * np.pi * j / 600), atol=1e-12)
    np.testing.assert_allclose(functions.T @ functions, np.eye(9), atol=1e-9)


def test_ritz_values_are_looked_at_seldom_and_no_step_too_many_is_taken(monkeypatch):
    """Of a large basis they cost as much as many steps."""
    seldom = calls_for_a_ring(monkeypatch)
    monkeypatch.setattr(block_lanczos, "_next_look", lambda looks, goal: 0)
    always = calls_for_a_ring(monkeypatch)
    assert seldom["_extend"] <= 1.1 * always["_extend"]
    assert seldom["_ritz"] <= 0.2 * seldom["_extend"]


def calls_for_a_ring(monkeypatch):
    """Return how often the iteration takes a step, and how often it looks at Ritz values, for many pairs."""
    counts = Counter()

    def counted(name, function):
        return lambda *arguments: counts.update([name]) or function(*arguments)

    start = np.random.default_rng(0).standard_normal((2000, 4))
    with monkeypatch.context() as patch:
        for name in ("_extend", "_ritz"):
            patch.setattr(block_lanczos, name, counted(name, getattr(block_lanczos, name)))
        smallest_eigenpairs(pencil_of(ring_of_springs(2000)), start, 60, 1e-6, silent)
    return counts


@pytest.mark.parametrize("scale", [0.5, 1e-6])
def test_a_factor_that_lies_is_not_believed(scale):
    """With a scaled inverse the recurrence converges all the same, to other values."""
    start = np.random.default_rng(0).standard_normal((600, 3))
    with pytest.raises((SpectrumError, np.linalg.LinAlgError)):
        smallest_eigenpairs(pencil_of(ring_of_springs(600), scale), start, 5, 1e-6, silent)


def test_where_the_iteration_fails_arpack_answers(monkeypatch):
    expected = solve_eigenbasis(icosphere(3), 8).values

    def fail(*_):
        raise SpectrumError("no")

    monkeypatch.setattr(eigensolver, "smallest_eigenpairs", fail)
    np.testing.assert_allclose(solve_eigenbasis(icosphere(3), 8).values, expected, rtol=1e-9)


def test_a_function_that_was_missed_is_noticed(monkeypatch):
    """True eigenpairs without the fourth: each has no residual, but linear elements tell that one must lie lower."""
    expected = solve_eigenbasis(icosphere(3), 8).values

    def gapped(pencil, start, n_pairs, *options):
        values, functions = smallest_eigenpairs(pencil, start, n_pairs + 1, *options)
        return np.delete(values, 3), np.delete(functions, 3, axis=1)

    monkeypatch.setattr(eigensolver, "smallest_eigenpairs", gapped)
    np.testing.assert_allclose(solve_eigenbasis(icosphere(3), 8).values, expected, rtol=1e-9)
