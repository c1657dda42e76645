"""Shapes in which no part stands out are one part; those that have a neck or arms are divided."""

import numpy as np
import pytest

from compute import analyze
from compute.segmentation.parts.part_labels import NOTHING_STANDS_OUT
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, lathe, star

BALL = icosphere(4)
CUBE = BALL.vertices / np.abs(BALL.vertices).max(axis=1, keepdims=True)
ROUND = np.maximum(np.linalg.norm(BALL.vertices[:, :2], axis=1), np.abs(BALL.vertices[:, 2]))
CYLINDER = BALL.vertices / ROUND[:, None]


def turned(radius, height):
    """A closed body of revolution."""
    profile = np.stack([np.r_[0, radius, 0], np.r_[height[0], height, height[-1]]], axis=1)
    return lathe(profile, 48)


def gear(n_teeth):
    wheel = CYLINDER * [1, 1, 0.25]
    wave = np.tanh(4 * np.sin(n_teeth * np.arctan2(wheel[:, 1], wheel[:, 0])))
    rim = np.clip(np.linalg.norm(wheel[:, :2], axis=1) * 3 - 2, 0, 1)
    return wheel * np.stack([1 + 0.15 * wave * rim] * 2 + [np.ones(len(wheel))], axis=1)


ALONG = np.linspace(0, 1, 60)
ONE_PART = {
    "box": CUBE * [3, 1, 1],
    "brick": CUBE * [2, 1, 0.6],
    "cube": CUBE,
    "plate": CUBE * [2, 1.5, 0.1],
    "rod": CYLINDER * [0.2, 0.2, 1],
    "disk": CYLINDER * [1, 1, 0.2],
    "ellipsoid": BALL.vertices * [2, 0.5, 1],
    "gear": gear(16),
    "small gear": gear(8),
    "dented ball": BALL.vertices * (1 - 0.7 * np.exp(-12 * (1 - BALL.vertices[:, 2:]))),
}


@pytest.mark.parametrize("name", ONE_PART)
def test_a_shape_without_clear_parts_is_one_part_and_says_so(name):
    segmentation = analyze(TriangleMesh(ONE_PART[name], BALL.triangles)).segment()
    assert segmentation.n_parts == 1
    assert segmentation.warnings == ((NOTHING_STANDS_OUT,) if segmentation.level else ())


def test_an_egg_and_a_cone_are_one_part():
    egg = turned(np.sqrt(np.maximum(1 - (2 * ALONG - 1) ** 2, 1e-3)) * (0.36 + 0.12 * ALONG), 1.2 * ALONG)
    assert analyze(egg).segment().n_parts == 1
    assert analyze(turned(0.5 * (1 - ALONG) + 0.01, ALONG)).segment().n_parts == 1


def test_its_ends_are_features_nevertheless():
    rod = analyze(TriangleMesh(ONE_PART["rod"], BALL.triangles))
    assert rod.segment(mode="features").n_parts >= 2
    assert rod.segment(mode="features").warnings == ()


def test_what_narrows_in_one_half_is_cut_there_and_not_in_the_middle():
    skittle = turned(np.interp(ALONG, [0, 0.05, 0.35, 0.7, 0.85, 1], [0.2, 0.25, 0.4, 0.15, 0.22, 0.08]), 1.6 * ALONG)
    labels = analyze(skittle).segment().labels
    height = skittle.vertices[skittle.triangles, 2].mean(axis=1)
    assert len(np.unique(labels)) == 2
    assert height[labels > 0].min() == pytest.approx(0.7 * 1.6, abs=0.06)


def ball(radius, middle, start, stop):
    """Distances from the axis and heights on a ball, by angles from below."""
    angle = np.linspace(start, stop, 30)
    return np.stack([radius * np.sin(angle), middle - radius * np.cos(angle)], axis=1)


@pytest.mark.parametrize("thickness", [0.1, 0.3, 0.6])
def test_balls_at_the_ends_of_a_rod_are_parts(thickness):
    """The balls of a barbell take next to nothing of the field's height."""
    neck = np.pi - np.arcsin(thickness)
    low = ball(1, 0, 0.05, neck)
    rod = np.stack([np.full(40, thickness), np.linspace(low[-1, 1] + 0.05, low[-1, 1] + 2.95, 40)], axis=1)
    profile = np.vstack([low, rod, ball(1, 2 * low[-1, 1] + 3, np.pi - neck, np.pi - 0.05)])
    segmentation = analyze(turned(*profile.T)).segment()
    sizes = segmentation.parts.area / segmentation.parts.area.sum()
    assert (sizes > 0.4).sum() == 2


def test_a_ball_on_a_stick_is_not_the_stick():
    head = ball(1, 0, 0.05, np.pi - np.arcsin(0.09))
    stick = np.stack([np.full(60, 0.09), np.linspace(head[-1, 1] + 0.05, 6, 60)], axis=1)
    mesh = turned(*np.vstack([head, stick]).T)
    labels, height = analyze(mesh).segment().labels, mesh.vertices[mesh.triangles, 2].mean(axis=1)
    (of_head,), (of_stick,) = np.unique(labels[height < 0.8]), np.unique(labels[height > 1.5])
    assert of_head != of_stick


def test_a_waist_divides_what_a_rod_does_not():
    waisted = turned(np.sqrt(0.04 + 0.6 * (ALONG - 0.5) ** 2), ALONG)
    segmentation = analyze(waisted).segment()
    sizes = segmentation.parts.area / segmentation.parts.area.sum()
    assert (sizes > 0.4).sum() == 2
    assert segmentation.warnings == ()


def test_arms_that_meet_in_a_ball_are_parts():
    assert analyze(star(3, 3)).segment().n_parts >= 3


def test_two_pieces_are_judged_each_by_itself():
    rod, waisted = ONE_PART["rod"], turned(np.sqrt(0.04 + 0.6 * (ALONG - 0.5) ** 2), ALONG)
    places = np.vstack([rod, waisted.vertices + np.array([3, 0, 0])])
    both = TriangleMesh(places, np.vstack([BALL.triangles, waisted.triangles + len(rod)]))
    labels = analyze(both, shells="separate").segment().labels
    assert len(np.unique(labels[: len(BALL.triangles)])) == 1
    assert len(np.unique(labels[len(BALL.triangles) :])) > 1
