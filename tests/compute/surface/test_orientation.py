"""Winding: what is spoiled at random comes back consistent and outward."""

import numpy as np
import pytest

from compute.surface.mesh import TriangleMesh
from compute.surface.orientation import outward_triangles, wrongly_wound
from tests.shapes import icosphere, rectangle, tetrahedron


def spoiled(mesh: TriangleMesh, share: float = 0.3) -> tuple[TriangleMesh, np.ndarray]:
    reversed_ones = np.random.default_rng(0).random(len(mesh.triangles)) < share
    return TriangleMesh(
        mesh.vertices, np.where(reversed_ones[:, None], mesh.triangles[:, ::-1], mesh.triangles)
    ), reversed_ones


@pytest.mark.parametrize("share", [0.0, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("mesh", [tetrahedron(2), icosphere(2)])
def test_closed_surfaces_turn_outward_wherever_they_lie(mesh, share):
    far = TriangleMesh(mesh.vertices + np.array([100, -50, 20]), mesh.triangles)
    broken, reversed_ones = spoiled(far, share)
    np.testing.assert_array_equal(wrongly_wound(broken), reversed_ones)


def test_surfaces_with_a_small_opening_turn_outward():
    sphere = icosphere(3)
    open_sphere = TriangleMesh(sphere.vertices, sphere.triangles[sphere.vertices[sphere.triangles][:, 0, 2] < 0.95])
    broken, reversed_ones = spoiled(open_sphere, 0.8)
    np.testing.assert_array_equal(wrongly_wound(broken), reversed_ones)


def test_sheets_follow_the_greater_part_of_their_area():
    broken, reversed_ones = spoiled(rectangle(10, 6), 0.3)
    np.testing.assert_array_equal(wrongly_wound(broken), reversed_ones)


def test_one_sided_surfaces_stay_as_they_are():
    strip = np.arange(12).reshape(6, 2)
    following = np.concatenate([strip[1:], strip[:1, ::-1]])
    triangles = np.concatenate([
        np.column_stack([strip, following[:, 0]]), np.column_stack([strip[:, 1], following[:, ::-1]])
    ])  # fmt: skip
    mobius = TriangleMesh(np.random.default_rng(0).random((12, 3)), triangles)
    np.testing.assert_array_equal(outward_triangles(mobius), triangles)


def test_shells_that_touch_are_turned_one_by_one():
    ball = icosphere(1)
    both = np.vstack([ball.triangles, ball.triangles[:, ::-1] + len(ball.vertices)])
    pair = TriangleMesh(np.vstack([ball.vertices, ball.vertices + np.array([2, 0, 0])]), both)
    np.testing.assert_array_equal(wrongly_wound(pair), np.arange(160) >= 80)
