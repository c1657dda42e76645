"""Nearest points of a surface that look the same way."""

import numpy as np

from compute.registration.dense.surface_points import SurfaceTree
from tests.shapes import icosphere


def test_the_nearest_point_of_a_sphere_lies_in_the_same_direction():
    sphere = icosphere(3)
    points = np.random.default_rng(0).normal(size=(50, 3))
    normals = points / np.linalg.norm(points, axis=1, keepdims=True)
    tree = SurfaceTree(sphere.vertices, sphere.triangles, turn=0.01, wrong_side=1.0)
    found, distance = tree.nearest(1.5 * normals, normals, 8)
    places = found.blend(sphere.vertices, sphere.triangles)
    assert np.einsum("ij,ij->i", places / np.linalg.norm(places, axis=1, keepdims=True), normals).min() > 0.999
    np.testing.assert_allclose(distance, 0.5, atol=0.02)


def test_the_other_side_of_a_thin_plate_is_not_taken():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    plate = np.vstack([square, square - [0, 0, 0.01]])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]])
    tree = SurfaceTree(plate, triangles, turn=0.01, wrong_side=1.0)
    found, _ = tree.nearest(np.array([[0.5, 0.4, -0.01]]), np.array([[0.0, 0, 1]]), 4)
    assert found.triangles[0] < 2


def test_an_inner_wall_is_found_from_within_and_the_outer_one_from_without():
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    walls = np.vstack([square, square + np.array([0, 0, 0.01])])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    tree = SurfaceTree(walls, triangles, turn=0.01, wrong_side=1.0, is_inner=np.array([False, False, True, True]))
    places, up = np.array([[0.5, 0.4, 0.009], [0.5, 0.4, 0.001]]), np.array([[0.0, 0, 1]] * 2)
    assert (tree.nearest(places, up, 4)[0].triangles < 2).all()
    assert (tree.nearest(places, up, 4, np.array([True, True]))[0].triangles >= 2).all()
