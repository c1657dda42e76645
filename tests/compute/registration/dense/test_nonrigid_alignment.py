"""A shape laid onto itself stays, and comes back from near by."""

import numpy as np
import pytest

from compute.registration.dense.deformation_graph import deformation_graph, motion_towards, warped
from compute.registration.dense.nonrigid_alignment import (
    RELAXATION,
    SLIDING,
    ClosestPoints,
    Pins,
    Round,
    Samples,
    aligned,
    gauss_newton_step,
)
from compute.registration.eigenfunctions.spectral_shape import spectral_shape


@pytest.fixture(scope="module")
def shape(ball):
    return spectral_shape(ball.matching_basis)


@pytest.fixture(scope="module")
def graph(shape):
    return deformation_graph(shape, 60)


def laid_onto_itself(shape, graph, motion, inner_target=False, inner_samples=False):
    points = np.arange(0, len(shape.positions), 3)
    samples = Samples(points, shape.normals[points], np.full(len(points), inner_samples))
    return aligned(graph, motion, samples, shape, np.full(len(shape.triangles), inner_target))


def test_a_shape_that_lies_on_its_target_stays(shape, graph):
    motion = laid_onto_itself(shape, graph, motion_towards(graph, graph.nodes))
    np.testing.assert_allclose(warped(graph, motion), shape.positions, atol=1e-6)


def test_a_shape_beside_its_target_is_laid_onto_it(shape, graph):
    away = motion_towards(graph, graph.nodes + np.array([0.02, -0.015, 0.01]))
    motion = laid_onto_itself(shape, graph, away)
    gap = np.linalg.norm(warped(graph, motion) - shape.positions, axis=1)
    assert gap.mean() < 0.1 * np.linalg.norm([0.02, -0.015, 0.01])


def test_outer_walls_are_not_drawn_to_inner_ones(shape, graph):
    away = motion_towards(graph, graph.nodes + np.array([0.02, -0.015, 0.01]))
    motion = laid_onto_itself(shape, graph, away, inner_target=True)
    np.testing.assert_allclose(warped(graph, motion), warped(graph, away), atol=1e-9)


def test_a_pinned_point_comes_to_its_place_and_takes_its_surroundings_along(shape, graph):
    """Its place is a little beside where it lies, on the surface."""
    away = np.linalg.norm(shape.positions - shape.positions[40], axis=1)
    order = np.argsort(away)
    place, around = shape.positions[order[6]], order[1:6]
    samples = Samples(order, shape.normals[order], np.zeros(len(order), dtype=bool))
    pins = Pins(np.array([40]), place[None])
    still = motion_towards(graph, graph.nodes)
    motion = aligned(graph, still, samples, shape, np.zeros(len(shape.triangles), dtype=bool), pins)
    moved = warped(graph, motion) - shape.positions
    np.testing.assert_allclose(moved[40], place - shape.positions[40], atol=0.02 * away[order[6]])
    assert (moved[around] @ moved[40] > 0.2 * moved[40] @ moved[40]).all()
    assert (np.linalg.norm(moved[away > 10 * away[order[6]]], axis=1) < 0.1 * away[order[6]]).all()


def test_distance_along_the_surface_hardly_counts(graph, shape):
    """Every other point is drawn up along its normal, the rest down across it; the stiff whole goes up."""
    is_up, up, across = np.arange(len(shape.positions)) % 2 == 0, np.array([0, 0, 1.0]), np.array([1.0, 0, 0])
    places = shape.positions + 1e-3 * np.where(is_up, 1, -1)[:, None] * up
    weights = np.full(len(places), 1 / len(places))
    closest = ClosestPoints(np.arange(len(places)), places, np.where(is_up[:, None], up, across), weights)
    still = motion_towards(graph, graph.nodes)
    step = warped(graph, gauss_newton_step(graph, still, closest, Round(stiffness=1e3, bend=np.inf))) - shape.positions
    np.testing.assert_allclose(step[:, 2], RELAXATION * 1e-3 / (1 + 2 * SLIDING**2), rtol=0.1)
