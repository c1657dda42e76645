"""Joints along lines whose corners and necks are known."""

import numpy as np
import pytest

from compute.skeletons.bends import N_POINTS, joints_along, resampled

ENDS = np.array([0, N_POINTS - 1])


def line(*corners, radius=0.1, n=40):
    """Return the curve of a limb through corners."""
    corners = np.array(corners, dtype=float)
    places = np.stack([np.interp(np.linspace(0, 1, n), np.linspace(0, 1, len(corners)), c) for c in corners.T], axis=1)
    return resampled(places[None], np.broadcast_to(radius, n).astype(float))[0]


def test_points_are_evenly_spaced_whatever_the_spacing_of_slices():
    uneven = np.linspace(0, 1, 30) ** 3
    curve, length = resampled(uneven[None, :, None] * [[[3.0, 0, 4.0]]], np.ones(30))
    np.testing.assert_allclose(np.diff(curve.along), 5 / (N_POINTS - 1))
    np.testing.assert_allclose(np.linalg.norm(np.diff(curve.places[0], axis=0), axis=1), 5 / (N_POINTS - 1), rtol=1e-6)
    assert length[-1] == pytest.approx(5)


def test_a_straight_limb_has_no_joints_but_its_ends():
    assert joints_along(line([0, 0, 0], [0, 0, 2]), ENDS).tolist() == ENDS.tolist()


def test_a_corner_is_a_joint():
    (corner,) = np.setdiff1d(joints_along(line([0, 0, 0], [1, 0, 0], [1, 1, 0]), ENDS), ENDS)
    assert corner == pytest.approx((N_POINTS - 1) / 2, abs=1)


def test_a_corner_that_only_another_pose_has_is_a_joint_too():
    bent, straight = line([0, 0, 0], [1, 0, 0], [1, 1, 0]), line([0, 0, 0], [1, 0, 0], [2, 0, 0])
    both = resampled(np.stack([straight.places[0], bent.places[0]]), np.full(N_POINTS, 0.1))[0]
    assert len(joints_along(both, ENDS)) == 3


def test_a_neck_is_a_joint_where_it_is_thinnest():
    radius = 0.1 + 0.1 * np.abs(np.linspace(-1, 2, 40))
    (neck,) = np.setdiff1d(joints_along(line([0, 0, 0], [0, 0, 3], radius=radius), ENDS), ENDS)
    assert neck == pytest.approx((N_POINTS - 1) / 3, abs=1)


@pytest.mark.parametrize("n_pieces", [1, 2, 3])
def test_long_straight_limbs_are_divided_evenly(n_pieces):
    joints = joints_along(line([0, 0, 0], [0, 0, 2]), ENDS, n_pieces)
    assert len(joints) == n_pieces + 1
    np.testing.assert_allclose(np.diff(joints), (N_POINTS - 1) / n_pieces, atol=1)


def test_short_limbs_are_not_divided():
    assert len(joints_along(line([0, 0, 0], [0, 0, 2], radius=0.5), ENDS, 3)) == 2


def test_where_joints_lie_does_not_depend_on_the_unit():
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1.3, 1, 1.0]])
    one, other = (joints_along(line(*(scale * corners), radius=0.1 * scale), ENDS, 2) for scale in (1, 1e3))
    np.testing.assert_array_equal(one, other)
