"""Moment tensors: closed forms on the sphere, and what turns them."""

import numpy as np
import pytest

from compute.registration.eigenfunctions.moments import (
    Moments,
    agreement,
    agreement_gradient,
    moments_of,
    point_areas,
    rotate_tensor,
)
from tests.shapes import icosphere

SPHERE = icosphere(3)
RANDOM = np.random.default_rng(0)


def moments(functions, triangles=SPHERE.triangles) -> Moments:
    return moments_of(functions, triangles, SPHERE.areas)


def test_the_alternating_moment_of_the_coordinates_is_the_volume():
    a, b, c = SPHERE.vertices[SPHERE.triangles].swapaxes(0, 1)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert moments(SPHERE.vertices).alternating[0, 1, 2] == pytest.approx(volume)


def test_the_symmetric_moment_of_the_constant_is_the_area():
    assert moments(np.ones((len(SPHERE.vertices), 1))).symmetric[0, 0, 0] == pytest.approx(SPHERE.areas.sum())
    assert point_areas(SPHERE.triangles, SPHERE.areas, len(SPHERE.vertices)).sum() == pytest.approx(SPHERE.areas.sum())


def test_winding_the_other_way_negates_the_alternating_moments_alone():
    functions = RANDOM.normal(size=(len(SPHERE.vertices), 4))
    plain, reversed_ones = moments(functions), moments(functions, SPHERE.triangles[:, ::-1])
    np.testing.assert_allclose(reversed_ones.alternating, -plain.alternating, atol=1e-12)
    np.testing.assert_allclose(reversed_ones.symmetric, plain.symmetric, atol=1e-12)


def test_moments_turn_with_the_functions():
    functions, rotation = RANDOM.normal(size=(len(SPHERE.vertices), 4)), np.linalg.qr(RANDOM.normal(size=(4, 4)))[0]
    turned, expected = moments(functions).rotated(rotation), moments(functions @ rotation.T)
    np.testing.assert_allclose(turned.symmetric, expected.symmetric, atol=1e-12)
    np.testing.assert_allclose(turned.alternating, expected.alternating, atol=1e-12)


def test_damped_moments_have_norm_one_and_agree_with_themselves():
    damped = moments(SPHERE.vertices * [1, 2, 3]).damped(np.array([2.0, 3.0, 5.0]))
    assert np.linalg.norm(damped.alternating) == pytest.approx(1)
    assert agreement(np.eye(3), damped.alternating, damped.alternating) == pytest.approx(1)


def test_the_gradient_is_a_third_of_the_difference_quotient():
    one, other = (moments(RANDOM.normal(size=(len(SPHERE.vertices), 3))).alternating for _ in range(2))
    rotation, direction = RANDOM.normal(size=(3, 3)), RANDOM.normal(size=(3, 3))
    ahead, behind = (agreement(rotation + step * direction, one, other) for step in (1e-5, -1e-5))
    slope = (agreement_gradient(rotation, one, other) * direction).sum()
    assert 3 * slope == pytest.approx((ahead - behind) / 2e-5, rel=1e-5)
    np.testing.assert_allclose(rotate_tensor(np.eye(3), one), one)
