"""Smoothing on the surface: heat equation on known shapes."""

import numpy as np
import pytest

from compute import MeshError
from compute.surface.heat_smoothing import biharmonic_fill, harmonic_fill, smoothed, softened_labels, stiffness
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


def test_the_widest_slope_is_the_mean():
    mesh = icosphere(3)
    soft = smoothed(mesh, (mesh.vertices[:, [2]] > 0.3).astype(float), width=1e30)
    mass = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas / 3, 3))
    np.testing.assert_allclose(soft, np.average(mesh.vertices[:, 2] > 0.3, weights=mass), rtol=1e-3)


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


def test_a_harmonic_fill_of_a_strip_is_nearly_linear():
    strip = rectangle(10, 1, width=10.0)
    x = strip.vertices[:, :1]
    is_known = (x[:, 0] < 0.5) | (x[:, 0] > 9.5)
    filled = harmonic_fill(strip, np.where(is_known[:, None], x, -5.0), is_known)
    np.testing.assert_allclose(filled, x, atol=0.3)
    np.testing.assert_array_equal(filled[is_known], x[is_known])


def test_a_harmonic_fill_keeps_constants_and_stays_between_what_is_known():
    sphere = icosphere(2)
    is_known = np.arange(len(sphere.vertices)) % 5 == 0
    values = np.column_stack([np.full(len(is_known), 3.0), np.random.default_rng(0).random(len(is_known))])
    filled = harmonic_fill(sphere, values, is_known)
    np.testing.assert_allclose(filled[:, 0], 3, rtol=1e-12)
    assert values[is_known, 1].min() <= filled[:, 1].min() <= filled[:, 1].max() <= values[is_known, 1].max()


def test_a_piece_without_anything_known_keeps_what_it_has():
    both = joined(icosphere(0), icosphere(0))
    values = np.arange(24.0)[:, None]
    filled = harmonic_fill(both, values, np.arange(24) == 3)
    np.testing.assert_array_equal(filled[12:], values[12:])
    np.testing.assert_allclose(filled[:12], 3)


def test_a_slope_goes_on_into_what_is_filled():
    mesh = rectangle(40, 10)
    x, y, _ = mesh.vertices.T
    values = np.stack([3 * x - 2 * y, np.ones_like(x)], axis=1)
    is_known = (x < 0.5) | (x > 1.5)
    filled = biharmonic_fill(mesh, np.where(is_known[:, None], values, 99.0), is_known)
    # At the open edges nothing holds the slope across.
    np.testing.assert_allclose(filled[:, 1], 1, atol=1e-6)
    middle = (y > 0.4) & (y < 0.6)
    np.testing.assert_allclose(filled[middle, 0], values[middle, 0], atol=0.2)


def test_what_is_filled_stays_between_what_is_known_and_loose_pieces_stay():
    ball = icosphere(2)
    mesh = joined(ball, ball)
    known = np.arange(len(mesh.vertices)) < len(ball.vertices)
    known &= mesh.vertices[:, 2] > 0.2
    values = np.where(known, mesh.vertices[:, 2] ** 2, -7.0)[:, None]
    filled = biharmonic_fill(mesh, values, known)
    first, second = np.split(filled[:, 0], 2)
    assert first.min() > 0.04
    assert first.max() <= 1
    assert (second == -7).all()
