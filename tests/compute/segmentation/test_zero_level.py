import numpy as np
import pytest

from compute import FieldError, analyze, zero_level
from tests.shapes import icosphere, joined, rectangle


@pytest.fixture(scope="module")
def long_rectangle():
    return analyze(rectangle(12, 4, width=3.0), n_functions=6)


def test_the_first_function_halves_a_rectangle(long_rectangle):
    halves = zero_level(long_rectangle)
    centres = long_rectangle.mesh.vertices[long_rectangle.mesh.triangles].mean(axis=1)
    is_left = centres[:, 0] < 1.5
    assert len(set(halves.labels[is_left].tolist())) == len(set(halves.labels[~is_left].tolist())) == 1
    np.testing.assert_allclose(halves.parts.area, [1.5, 1.5])


def test_cosine_n_has_n_plus_one_pieces(long_rectangle):
    """The first eigenvalues of a 3 x 1 rectangle are (pi / 3)^2, 4 (pi / 3)^2, then two alike."""
    assert zero_level(long_rectangle, 2).n_parts == 3


def test_courant(long_rectangle):
    """The n-th eigenfunction has at most n + 1 nodal pieces, the constant not counted."""
    for function in range(1, 7):
        assert zero_level(long_rectangle, function).n_parts <= function + 1


def test_tips_are_where_the_function_is_furthest_from_zero(long_rectangle):
    halves = zero_level(long_rectangle)
    assert sorted(long_rectangle.net.positions[halves.parts.extremum, 0].round(9).tolist()) == [0.0, 3.0]


def test_loose_parts_follow():
    mesh = joined(icosphere(2), type(icosphere(0))(0.1 * icosphere(1).vertices + [0, 0, 1], icosphere(1).triangles))
    halves = zero_level(analyze(mesh, n_functions=3))
    assert halves.n_parts == 2
    assert halves.parts.n_triangles.sum() == len(mesh.triangles)


def test_refuses_a_function_that_was_not_computed(long_rectangle):
    with pytest.raises(FieldError, match="1 to 6"):
        zero_level(long_rectangle, 7)
