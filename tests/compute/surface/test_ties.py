"""What differs by rounding alone decides nothing."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from compute import TriangleMesh, analyze, skeleton, zero_level
from compute.skeletons.interior import Interior
from compute.surface.ties import evened, first_largest, first_least, first_nearest
from tests.shapes import star, tetrahedron

ROUNDED = 1e-12


def test_numbers_that_tie_are_made_equal_and_others_stay():
    even = evened(np.array([3.0, 1.0 + ROUNDED, 2.0, 1.0, 2.0 - ROUNDED]))
    assert even.tolist() == [3, 1, 2 - ROUNDED, 1, 2 - ROUNDED]


def test_what_ties_is_told_by_the_size_that_is_given():
    assert len(set(evened(np.array([0.0, 1e-7]), size=1.0))) == 2
    assert len(set(evened(np.array([0.0, 1e-7]), size=100.0))) == 1


def test_of_equally_good_candidates_the_first_is_taken():
    rows = np.array([[2.0, 1.0 + ROUNDED, 1.0], [0.0, 3.0 - ROUNDED, 3.0]])
    assert first_least(rows).tolist() == [1, 0]
    assert first_largest(rows).tolist() == [0, 1]


def test_of_equally_near_places_the_first_is_taken():
    ring = 2 * np.pi * np.arange(12) / 12
    places = np.stack([np.cos(ring), np.sin(ring), np.zeros(12)], axis=1)
    around = ROUNDED * np.vstack([np.eye(3), -np.eye(3)])
    assert first_nearest(cKDTree(places), around).tolist() == [0] * 6
    assert first_nearest(cKDTree(places), 0.9 * places).tolist() == list(range(12))


@pytest.mark.parametrize("seed", range(3))
def test_the_parts_and_joints_of_equal_arms_do_not_change_when_their_field_is_rounded_otherwise(seed):
    shape = star(5, growth=0)
    values = analyze(shape, order=1).field.values
    noise = ROUNDED * np.random.default_rng(seed).standard_normal(len(values))
    exact, rounded = analyze(shape, field=values), analyze(shape, field=values + noise)
    for level in range(exact.hierarchy.n_levels):
        np.testing.assert_array_equal(exact.segment(level=level).labels, rounded.segment(level=level).labels)
    np.testing.assert_allclose(skeleton(exact).joints, skeleton(rounded).joints, atol=1e-6)
    np.testing.assert_array_equal(skeleton(exact).bone_of_vertex, skeleton(rounded).bone_of_vertex)


@pytest.mark.parametrize("seed", range(3))
def test_faces_halved_by_the_zero_level_do_not_change_sides_when_the_shape_is_rounded_otherwise(seed):
    shape = star(4, growth=0)
    noise = ROUNDED * np.random.default_rng(seed).standard_normal(shape.vertices.shape)
    moved = TriangleMesh(shape.vertices + noise, shape.triangles)
    halves = [zero_level(analyze(mesh, order=1), 1).labels for mesh in (shape, moved)]
    np.testing.assert_array_equal(*halves)


def test_a_point_within_a_flat_side_is_pulled_into_the_middle_however_it_is_rounded():
    shape = tetrahedron(3)
    interior = Interior.of(analyze(shape, order=1).surface)
    middle_of_side = shape.vertices[:3].mean(axis=0)
    points = middle_of_side + ROUNDED * np.vstack([np.eye(3), -np.eye(3)])
    pulled = interior.centred(points, np.full(6, 9.0))
    np.testing.assert_allclose(pulled, pulled[:1].repeat(6, axis=0), atol=1e-6)
    assert interior.holds(pulled).all()
