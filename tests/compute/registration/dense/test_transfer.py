"""Displacements, seams and labels along a correspondence."""

import numpy as np

from compute import TriangleMesh, correspond, match
from compute.registration.dense.transfer import (
    islands,
    local_turns,
    majority_of_polygons,
    mixed,
    transfer_corners,
    transfer_displacements,
)
from tests.compute.registration.shapes import moved, quick, shuffled


def test_displacements_turn_with_the_surface_and_grow_with_it(ball):
    other, order = shuffled(moved(ball.mesh))
    found = correspond(ball, quick(other))
    pushes = np.random.default_rng(0).normal(size=ball.mesh.vertices.shape)
    pushed = moved(TriangleMesh(ball.mesh.vertices + pushes, ball.mesh.triangles)).vertices
    expected = (pushed - moved(ball.mesh).vertices)[order]
    np.testing.assert_allclose(transfer_displacements(found, ball.mesh, other, pushes), expected, atol=1e-6)


def test_turns_of_a_mirror_image_are_reflections(ball):
    mirrored = shuffled(TriangleMesh(ball.mesh.vertices * [1, -1, 1], ball.mesh.triangles[:, ::-1]))[0]
    target = quick(mirrored)
    found = correspond(ball, target, matching=match(ball, target, mirrored=True))
    turns = local_turns(found, ball.mesh, mirrored)
    np.testing.assert_allclose(turns, np.broadcast_to(np.diag([1, -1, 1]), turns.shape), atol=1e-6)


def test_no_face_lies_across_a_seam(to_finer, ball, finer):
    right = ball.mesh.vertices[ball.mesh.triangles].mean(axis=1)[:, 0] > 0
    values = ball.mesh.vertices[ball.mesh.triangles][..., 1:] + 100 * right[:, None, None]
    assert islands(ball.mesh.triangles, values).max() == 1
    triangles = finer.mesh.triangles
    corner_triangle = np.repeat(np.arange(len(triangles)), 3)
    found, keeps_seams = transfer_corners(to_finer, ball.mesh, values, triangles.ravel(), corner_triangle)
    assert keeps_seams
    assert np.ptp(found.reshape(-1, 3, 2), axis=1).max() < 5


def test_the_majority_of_a_polygon_is_by_area():
    labels, areas, polygon = np.array([5, 3, 3, 9]), np.array([3.0, 1, 1, 0]), np.array([0, 0, 0, 2])
    np.testing.assert_array_equal(majority_of_polygons(labels, areas, polygon, 3), [5, 0, 9])


def test_a_mix_is_between_what_is_there_and_what_comes():
    before, after = np.zeros((3, 2)), np.ones((3, 2))
    np.testing.assert_array_equal(mixed(before, after, np.array([0, 0.25, 1])), [[0, 0], [0.25, 0.25], [1, 1]])
