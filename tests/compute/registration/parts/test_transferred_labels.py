"""Labels of a reference on another shape, point by point."""

from dataclasses import replace

import numpy as np
import pytest

from compute import analyze
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from compute.registration.parts.transferred_labels import divisible, given_parts, transfer_labels
from tests.compute.registration.shapes import lumpy_ball


@pytest.fixture(scope="module")
def shape():
    analysis = analyze(lumpy_ball(), order=1)
    return divisible(analysis, spectral_shape(analysis.matching_basis)), analysis.segment(mode="features")


@pytest.fixture(scope="module")
def given(shape):
    return given_parts(shape[1].labels, shape[1].parts, shape[0])


def no_cuts(shape):
    return [np.zeros(len(tree.parent), dtype=np.int64) for tree in shape.part_tree.hierarchy.trees]


def test_shares_around_a_point_sum_to_one(given, shape):
    np.testing.assert_allclose(given.shares.sum(axis=1), 1)
    inside = shape[0].shape.point_areas @ given.shares / shape[0].shape.areas.sum()
    expected = [(shape[1].labels == part) @ shape[0].graph.area for part in [0, *given.id]]
    np.testing.assert_allclose(inside, np.array(expected) / shape[0].graph.area.sum(), atol=1e-9)


def test_faces_of_the_same_numbers_keep_their_labels(given, shape):
    labels = transfer_labels(given, shape[0], None, no_cuts(shape[0]), 0)
    np.testing.assert_array_equal(labels.faces, shape[1].labels)
    np.testing.assert_array_equal(labels.parts.id, shape[1].parts.id)


def test_a_shape_mapped_to_itself_keeps_its_labels_but_for_smoothed_borders(given, shape):
    drawn = replace(given, is_drawn=np.ones(len(given.id), dtype=bool))
    point_map = np.arange(len(shape[0].shape.positions))
    labels = transfer_labels(drawn, shape[0], point_map, no_cuts(shape[0]), 0).faces
    assert shape[0].graph.area[labels == shape[1].labels].sum() > 0.97 * shape[0].graph.area.sum()


def test_parts_without_a_partner_go_to_the_part_they_grow_out_of(given, shape):
    point_map = np.arange(len(shape[0].shape.positions))
    labels = transfer_labels(given, shape[0], point_map, no_cuts(shape[0]), 0)
    assert len(given.id) > 1
    assert set(labels.faces.tolist()) == {0}
