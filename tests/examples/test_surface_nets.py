"""Bodies as distance fields, and their meshes."""

import numpy as np
import pytest
from scipy.optimize import check_grad

from examples.grid import well_composed_inside
from examples.magnifier import Magnifier, Magnifiers
from examples.solids import Body, Solid
from examples.surface_net import mesh_body

CONE = Solid("bone", (0.1, -0.2, 0.0), (0.5, 0.3, 0.2), (0.3, 0.1))


def random_points(n=200):
    return np.random.default_rng(0).uniform(-1, 1, (n, 3))


def test_a_rounded_cone_is_the_union_of_the_balls_along_its_axis():
    points, share = random_points(), np.linspace(0, 1, 20001)[:, None]
    centres = np.array(CONE.start) + share * np.subtract(CONE.end, CONE.start)
    radii = CONE.radii[0] + share[:, 0] * (CONE.radii[1] - CONE.radii[0])
    nearest = [(np.linalg.norm(point - centres, axis=1) - radii).min() for point in points]
    np.testing.assert_allclose(CONE.distance(points)[0], nearest, atol=1e-7)


@pytest.mark.parametrize("symmetric", [True, False])
def test_the_gradient_is_the_derivative_of_the_distance(symmetric):
    ball = Solid("bone", (0.4, 0.1, 0.3), (0.4, 0.1, 0.3), (0.3, 0.3), blend=0.3)
    body = Body((CONE, ball), symmetric)
    for point in random_points(40):
        error = check_grad(lambda x: body.distance(x[None])[0][0], lambda x: body.distance(x[None])[1][0], point)
        assert error < 1e-5


def test_leaving_out_what_is_far_changes_nothing_near_the_surface():
    body = Body((CONE, Solid("bone", (-0.5, 0.0, 0.0), (0.0, 0.0, 0.6), (0.1, 0.2), blend=0.2)))
    points = random_points(5000)
    exact, near = body.distance(points)[0], body.distance(points, 0.05)[0]
    close = np.abs(exact) < 0.05
    np.testing.assert_array_equal(near[close], exact[close])
    np.testing.assert_array_equal(near < 0, exact < 0)


def test_the_mesh_of_a_ball_is_a_sphere():
    ball = Body((Solid("bone", (0.0, 1.0, 2.0), (0.0, 1.0, 2.0), (0.5, 0.5)),))
    mesh = mesh_body(ball, 3000, Magnifiers())
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices - (0, 1, 2), axis=1), 0.5, rtol=1e-9)
    a, b, c, d = mesh.vertices[mesh.quads].swapaxes(0, 1)
    assert np.linalg.norm(np.cross(c - a, d - b), axis=1).sum() / 2 == pytest.approx(np.pi, rel=2e-3)


def test_magnifying_makes_the_mesh_finer_by_the_factor():
    rod = Body((Solid("bone", (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.1, 0.1)),))
    mesh = mesh_body(rod, 40000, Magnifiers((Magnifier(0, 0.4, 0.6, 3.0, (0.0, 0.0, 0.0)),)))
    x = np.abs(mesh.vertices[:, 0])
    assert np.sum((x > 0.6) & (x < 0.9)) / np.sum(x < 0.3) == pytest.approx(9, rel=0.1)


def test_shrinking_undoes_magnifying():
    magnifiers = Magnifiers((Magnifier(0, 0.2, 0.5, 3.0, (0, 0.1, 0.2)), Magnifier(2, 0.3, 0.7, 2.0, (0, 0, 0))))
    points = random_points()
    np.testing.assert_allclose(magnifiers.shrunk(magnifiers.magnified(points)), points, atol=1e-6)


@pytest.mark.parametrize("meeting", [((2, 2, 2), (3, 3, 2)), ((2, 2, 2), (2, 3, 3)), ((2, 2, 2), (3, 3, 3))])
def test_points_that_meet_at_an_edge_or_a_corner_only_are_parted_or_joined(meeting):
    values = np.ones((6, 6, 6), dtype=np.float32)
    for place, point in enumerate(meeting):
        values[point] = -1 - place
    inside = well_composed_inside(values)
    corners = [inside[i : 5 + i, j : 5 + j, k : 5 + k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    assert inside.any()
    assert not any((a & d & ~b & ~c).any() for a, b, c, d in [corners[:4], corners[4:], corners[::2], corners[1::2]])


def test_a_cavity_is_filled():
    values = -np.ones((5, 5, 5), dtype=np.float32)
    values[[0, -1]] = values[:, [0, -1]] = values[:, :, [0, -1]] = values[2, 2, 2] = 1
    assert well_composed_inside(values).sum() == 27
