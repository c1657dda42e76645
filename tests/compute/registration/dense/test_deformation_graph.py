"""Points that follow nodes: rigid motions are exact."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from compute.registration.dense.deformation_graph import (
    Motion,
    deformation_graph,
    motion_towards,
    nearest_rotations,
    turned,
    warped,
)
from compute.registration.eigenfunctions.spectral_shape import spectral_shape

TURN = Rotation.from_euler("xyz", [0.4, -1.1, 2.0]).as_matrix()
SHIFT = np.array([0.5, -2.0, 1.0])


@pytest.fixture(scope="module")
def shape(ball):
    return spectral_shape(ball.matching_basis)


@pytest.fixture(scope="module")
def graph(shape):
    return deformation_graph(shape, 40)


def test_each_point_follows_four_nodes_with_weights_that_sum_to_one(graph):
    assert graph.followed.shape == graph.weights.shape == (len(graph.points), 4)
    np.testing.assert_allclose(graph.weights.sum(axis=1), 1)
    assert graph.weights.min() >= 0


def test_a_node_follows_itself_most(graph):
    node, point = np.nonzero((graph.nodes[:, None] == graph.points).all(axis=2))
    assert len(node) == 40
    np.testing.assert_array_equal(graph.followed[point, graph.weights[point].argmax(axis=1)], node)


def test_without_motion_all_points_stay(graph):
    still = Motion(np.broadcast_to(np.eye(3), (40, 3, 3)), np.zeros((40, 3)))
    np.testing.assert_allclose(warped(graph, still), graph.points, atol=1e-12)


def test_nodes_that_move_rigidly_take_all_points_with_them(graph, shape):
    motion = motion_towards(graph, graph.nodes @ TURN.T + SHIFT)
    np.testing.assert_allclose(motion.rotations, np.broadcast_to(TURN, (40, 3, 3)), atol=1e-9)
    np.testing.assert_allclose(warped(graph, motion), graph.points @ TURN.T + SHIFT, atol=1e-9)
    chosen = np.arange(0, len(graph.points), 7)
    looks = turned(graph, motion, shape.normals[chosen], chosen)
    np.testing.assert_allclose(looks, shape.normals[chosen] @ TURN.T, atol=1e-9)


def test_the_nearest_rotation_is_never_a_reflection():
    before = np.random.default_rng(0).normal(size=(20, 3))
    spreads = [before.T @ (before @ matrix.T) for matrix in (TURN, TURN @ np.diag([1, 1, -1]))]
    exact, reflected = nearest_rotations(np.stack(spreads))
    np.testing.assert_allclose(exact, TURN, atol=1e-12)
    assert np.linalg.det(reflected) == pytest.approx(1)
