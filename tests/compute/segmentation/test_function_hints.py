"""Which eigenfunction suits a shape."""

import numpy as np
import pytest

from compute import TriangleMesh, analyze, solve_eigenbasis
from compute.segmentation.parts.function_hints import judge_eigenfunctions
from tests.shapes import icosphere, star


@pytest.fixture(scope="module")
def hints():
    return judge_eigenfunctions(solve_eigenbasis(star(5, 3), 12, order=2))


def test_all_arms_of_a_star_are_protrusions(hints):
    assert {hint.n_protrusions for hint in hints} == {5}
    assert sorted(hint.number for hint in hints) == list(range(1, 9))


def test_the_best_one_holds_more_protrusions_than_the_first(hints):
    """The first function of a star has one sign on each side, so arms share their parts."""
    first = next(hint for hint in hints if hint.number == 1)
    assert hints[0].n_held > first.n_held
    assert [hint.n_held for hint in hints] == sorted((hint.n_held for hint in hints), reverse=True)


def test_the_count_is_that_of_the_division_itself(hints):
    mesh = star(5, 3)
    for hint in hints[:2]:
        analysis = analyze(mesh, field=hint.number, order=2)
        assert abs(len(analysis.segment(mode="features").parts) - 1 - hint.n_parts) <= 1


def test_the_first_function_of_a_stick_has_no_saddle_and_the_second_holds_both_ends():
    stick = TriangleMesh(icosphere(3).vertices * [4, 1, 1], icosphere(3).triangles)
    hints = judge_eigenfunctions(solve_eigenbasis(stick, 8, order=1))
    assert (hints[0].number, hints[0].n_held, hints[0].n_protrusions) == (2, 2, 2)
    assert next(hint.n_parts for hint in hints if hint.number == 1) == 0


def test_a_flipped_sign_changes_nothing(hints):
    basis = solve_eigenbasis(star(5, 3), 12, order=2)
    flipped = type(basis)(**{**basis.__dict__, "functions": basis.functions * np.where(np.arange(12) % 2, 1, -1)})
    assert judge_eigenfunctions(flipped) == hints
