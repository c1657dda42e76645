"""Smoothing on the surface: heat equation on known shapes."""

import numpy as np
import pytest

from compute import MeshError
from compute.geodesics import smoothed, softened_labels, stiffness
from tests.shapes import icosphere, joined, rectangle


def test_the_stiffness_is_the_energy_of_linear_functions():
    mesh = rectangle(8, 4)
    x, y, _ = mesh.vertices.T
    slope = 3 * x - 2 * y
    assert slope @ stiffness(mesh) @ slope == pytest.approx((3**2 + 2**2) * mesh.areas.sum())
    np.testing.assert_allclose(stiffness(mesh).sum(axis=0), 0, atol=1e-12)


def test_a_step_becomes_a_slope_of_the_given_width():
    """From 90 % at half the width before the line to 10 % at half the width behind it."""
    mesh = rectangle(400, 4)
    x = mesh.vertices[:, 0]
    soft = smoothed(mesh, (x < 1).astype(float)[:, None], width=0.4)[:, 0]
    np.testing.assert_allclose(np.interp([0.8, 1.2], x[2::5], soft[2::5]), [0.9, 0.1], atol=0.01)


def test_constants_stay_and_integrals_too():
    mesh = icosphere(3)
    values = np.stack([np.full(len(mesh.vertices), 2.0), mesh.vertices[:, 2] > 0.3], axis=1)
    mass = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas / 3, 3))
    soft = smoothed(mesh, values, width=0.7)
    np.testing.assert_allclose(soft[:, 0], 2, rtol=1e-5)
    np.testing.assert_allclose(mass @ soft, mass @ values, rtol=1e-5)


def test_nothing_passes_to_a_loose_piece():
    first = icosphere(2)
    mesh = joined(first, first)
    inside = np.repeat([1.0, 0.0], len(first.vertices))
    np.testing.assert_allclose(smoothed(mesh, inside[:, None], width=5.0)[:, 0], inside, atol=1e-5)


def test_a_width_of_zero_leaves_borders_hard():
    mesh = icosphere(2)
    labels = (mesh.vertices[:, 0] > 0).astype(np.int32) * 4
    kinds, weights = softened_labels(mesh, labels, 0.0)
    np.testing.assert_array_equal(kinds, [0, 4])
    np.testing.assert_allclose(weights[:, 1], labels == 4, atol=1e-6)


def test_weights_add_up_to_one():
    mesh = icosphere(3)
    labels = np.digitize(mesh.vertices[:, 2], [-0.5, 0.1, 0.2]).astype(np.int32)
    _, weights = softened_labels(mesh, labels, 0.5)
    np.testing.assert_allclose(weights.sum(axis=1), 1)
    assert weights.min() >= 0


@pytest.mark.parametrize("width", [-1.0, np.nan, np.inf])
def test_a_width_that_is_no_distance_is_refused(width):
    mesh = icosphere(1)
    with pytest.raises(MeshError, match="distance"):
        smoothed(mesh, mesh.vertices, width)
