"""Points of a target that land on points of a source."""

import numpy as np

from compute import match
from compute.registration.dense.point_map import point_map, refined_functional_map
from compute.registration.eigenfunctions.matching import match_by_number
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from tests.compute.registration.shapes import moved, quick, shuffled


def test_points_of_one_topology_correspond_by_number(ball):
    shape = spectral_shape(ball.matching_basis)
    np.testing.assert_array_equal(point_map(shape, shape, match_by_number(shape, shape)), np.arange(1442))


def test_points_of_a_shuffled_copy_land_on_what_they_were(ball):
    mesh, order = shuffled(moved(ball.mesh))
    copy = quick(mesh)
    source, target = spectral_shape(ball.matching_basis), spectral_shape(copy.matching_basis)
    landed = source.node[point_map(source, target, match(ball, copy))]
    is_vertex = target.node < len(order)
    np.testing.assert_array_equal(landed[is_vertex], order[target.node[is_vertex]])


def test_the_map_of_a_shape_to_itself_is_the_identity(ball):
    shape = spectral_shape(ball.matching_basis)
    grown = refined_functional_map(shape, shape, match_by_number(shape, shape), np.arange(len(shape.positions)))
    np.testing.assert_allclose(grown, np.eye(100), atol=1e-6)
