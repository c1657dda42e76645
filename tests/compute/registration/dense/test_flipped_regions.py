"""A region that a rough map takes for its mirror image is found, and goes on from what surrounds it."""

import numpy as np
import pytest

from compute.registration.dense.deformation_graph import deformation_graph, motion_towards
from compute.registration.dense.flipped_regions import RoughMap, node_orientations, with_regions_unflipped
from compute.registration.dense.nonrigid_alignment import Samples
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from tests.compute.registration.shapes import quick
from tests.shapes import lathe


@pytest.fixture(scope="module")
def skittle():
    """A body with a neck and a head above it."""
    height = np.linspace(-3, 3, 60)
    body, head = 1.2 * np.exp(-((height + 1.5) ** 2)), 0.9 * np.exp(-((height - 2) ** 2) / 0.6)
    radius = (0.35 + body + head) * np.sqrt(np.maximum(1 - (height / 3) ** 8, 0))
    return spectral_shape(quick(lathe(np.stack([radius, height], axis=1), 40)).matching_basis)


@pytest.fixture(scope="module")
def graph(skittle):
    return deformation_graph(skittle, 150)


def rough_map(shape, is_flipped, mirror=(-1.0, 1.0, 1.0)):
    """Map a shape onto itself, but points of a mask onto their mirror images."""
    points = np.arange(0, len(shape.positions), 2)
    flips = np.where(is_flipped[points, None], mirror, 1.0)
    samples = Samples(points, shape.normals[points], np.zeros(len(points), dtype=bool))
    return RoughMap(samples, shape.positions[points] * flips, shape.normals[points] * flips)


def is_head(points):
    return points[:, 2] > 0.4 * points[:, 2].max()


def mapped_nodes(graph, rough):
    """Shift each node as the sample next to it is."""
    away = np.linalg.norm(graph.points[rough.samples.points][None] - graph.nodes[:, None], axis=2)
    return motion_towards(graph, rough.places[away.argmin(axis=1)])


def test_a_map_onto_the_same_side_is_one_and_onto_the_mirror_image_minus_one(skittle, graph):
    orientation = node_orientations(graph, rough_map(skittle, is_head(skittle.positions)))
    top, bottom = (graph.nodes[:, 2] * side > 0.6 * skittle.positions[:, 2].max() for side in (1, -1))
    assert orientation[top].max() < -0.5
    assert orientation[bottom].min() > 0.5


def test_a_flipped_head_goes_on_from_the_neck(skittle, graph):
    rough = rough_map(skittle, is_head(skittle.positions))
    motion = with_regions_unflipped(graph, mapped_nodes(graph, rough), rough)
    shift, wrong = (np.linalg.norm(one.shifts, axis=1) for one in (motion, mapped_nodes(graph, rough)))
    head = is_head(graph.nodes)
    assert wrong[head].mean() > 0.15
    assert shift[head].max() < 0.08


def test_a_turned_head_is_not_flipped(skittle, graph):
    rough = rough_map(skittle, is_head(skittle.positions), mirror=(-1.0, -1.0, 1.0))
    motion = mapped_nodes(graph, rough)
    np.testing.assert_array_equal(with_regions_unflipped(graph, motion, rough).shifts, motion.shifts)


def test_a_shape_that_is_flipped_as_a_whole_has_nothing_to_go_on_from(skittle, graph):
    rough = rough_map(skittle, np.ones(len(skittle.positions), dtype=bool))
    motion = mapped_nodes(graph, rough)
    np.testing.assert_array_equal(with_regions_unflipped(graph, motion, rough).shifts, motion.shifts)
