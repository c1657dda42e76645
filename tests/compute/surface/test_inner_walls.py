"""Mouth bags, gaps between double walls and hidden shells lie inside; folds, hollows and closed bodies do not."""

import numpy as np
import pytest

from compute import TriangleMesh
from compute.surface.inner_walls import inner_vertices, inner_walls, openness
from examples import humanoid
from tests.shapes import icosphere, joined, lathe


def arc(radius, start, stop, n=24):
    """Return (n, 2) distance from the axis and height along an arc, in degrees from the top."""
    angle = np.radians(np.linspace(start, stop, n))
    return radius * np.stack([np.sin(angle), np.cos(angle)], axis=1)


@pytest.fixture(scope="module")
def ball_with_bag():
    """A ball whose surface goes in through a hole of 12 degrees and forms a bag inside."""
    bag = arc(0.6, 20, 180)
    return lathe(np.vstack([arc(1.0, 180, 12), bag]), 48), len(bag)


def is_in_bag(mesh):
    return np.linalg.norm(mesh.vertices[mesh.triangles].mean(axis=1), axis=1) < 0.65


def test_a_bag_behind_a_narrow_opening_lies_inside(ball_with_bag):
    mesh, _ = ball_with_bag
    share = mesh.areas / mesh.areas.sum()
    assert share[inner_walls(mesh) != is_in_bag(mesh)].sum() < 0.02


def test_winding_and_holes_do_not_matter(ball_with_bag):
    mesh, _ = ball_with_bag
    random = np.random.default_rng(0)
    kept = random.random(len(mesh.triangles)) > 0.01
    triangles = np.where(random.random((len(mesh.triangles), 1)) < 0.5, mesh.triangles[:, ::-1], mesh.triangles)
    damaged = TriangleMesh(mesh.vertices, triangles[kept])
    share = damaged.areas / damaged.areas.sum()
    assert share[inner_walls(damaged) != is_in_bag(damaged)].sum() < 0.05


def test_turned_and_scaled_the_same_lies_inside(ball_with_bag):
    mesh, _ = ball_with_bag
    turn = np.linalg.qr(np.random.default_rng(2).standard_normal((3, 3)))[0]
    moved = TriangleMesh(1e-3 * mesh.vertices @ turn.T + 5, mesh.triangles)
    share = mesh.areas / mesh.areas.sum()
    assert share[inner_walls(mesh) != inner_walls(moved)].sum() < 0.02


def test_the_hollow_of_a_cup_is_seen_but_not_the_gap_in_its_wall():
    cup = lathe(np.array([[0, 0], [1, 0], [1, 0.7], [1, 1.4], [0.8, 1.4], [0.8, 0.8], [0.8, 0.2], [0, 0.2]]), 48)
    gap = lathe(np.array([[0.87, 0.25], [0.93, 0.25], [0.93, 1.3], [0.87, 1.3], [0.87, 0.25]]), 48)
    found = inner_walls(joined(cup, gap))
    n_cup = len(cup.triangles)
    assert not found[:n_cup].any()
    assert found[n_cup:].all()


def test_a_shell_within_a_shell_lies_inside():
    ball = icosphere(3)
    inner = TriangleMesh(0.5 * ball.vertices, ball.triangles)
    np.testing.assert_array_equal(inner_walls(joined(ball, inner)), np.arange(2 * len(ball.triangles)) >= 1280)


def test_nothing_of_a_person_lies_inside_though_a_pose_presses_skin_together():
    character = humanoid(4000)
    for pose in ("rest", "walk", "sit", "reach"):
        mesh = TriangleMesh(character.mesh_in_pose(pose), character.triangles)
        assert mesh.areas[inner_walls(mesh)].sum() < 1e-3 * mesh.areas.sum(), pose


def test_an_open_sheet_is_seen_from_everywhere():
    sheet = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    assert openness(sheet).min() > 0.99
    assert not inner_walls(sheet).any()


def test_inner_vertices_have_inner_triangles_only():
    triangles = np.array([[0, 1, 2], [2, 1, 3]])
    assert inner_vertices(triangles, np.array([True, False]), 5).tolist() == [True, False, False, False, False]
