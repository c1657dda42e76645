"""The inside of a ball."""

import numpy as np
import pytest

from compute.skeletons.interior import Interior
from compute.surface.cleaning import clean_surface
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere

SPHERE = icosphere(3)
DIRECTIONS = np.random.default_rng(0).normal(size=(30, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)


@pytest.fixture(scope="module", params=[False, True], ids=["outward", "inward"])
def ball(request):
    triangles = SPHERE.triangles[:, ::-1] if request.param else SPHERE.triangles
    return Interior.of(clean_surface(TriangleMesh(SPHERE.vertices, triangles)))


def test_points_within_the_radius_are_inside(ball):
    assert ball.holds(0.98 * DIRECTIONS).all()
    assert not ball.holds(1.02 * DIRECTIONS).any()


@pytest.mark.parametrize("depth", [1.3, 1.01, 0.95])
def test_points_outside_or_under_the_skin_go_to_the_centre(ball, depth):
    np.testing.assert_allclose(ball.centred(depth * DIRECTIONS, np.full(30, 5.0)), 0, atol=0.1)


def test_points_go_no_deeper_than_they_are_let(ball):
    centred = ball.centred(1.01 * DIRECTIONS, np.full(30, 0.3))
    np.testing.assert_allclose(np.linalg.norm(centred, axis=1), 0.7, atol=0.02)


def test_points_deep_inside_stay(ball):
    np.testing.assert_array_equal(ball.centred(0.5 * DIRECTIONS, np.full(30, 5.0)), 0.5 * DIRECTIONS)


def test_all_that_is_pulled_inside_is_inside(ball):
    points = np.random.default_rng(1).uniform(-2, 2, size=(60, 3))
    assert ball.holds(ball.pulled_inside(points, np.full(60, 0.1))).all()
