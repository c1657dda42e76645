"""Vertices with and without faces."""

import numpy as np

from compute import TriangleMesh, analyze
from compute.registration.dense.by_number import map_by_number
from compute.registration.dense.shape_pair import triangle_around
from compute.registration.eigenfunctions.shape_points import nearest_known
from tests.shapes import tetrahedron


def test_unknown_vertices_are_stood_for_by_the_nearest_known():
    places = np.array([[0.0, 0, 0], [1, 0, 0], [1.4, 0, 0], [-9, 0, 0]])
    assert nearest_known(places, np.array([True, True, False, False])).tolist() == [0, 1, 1, 0]


def test_each_vertex_is_a_corner_of_the_triangle_around_it():
    triangles = np.array([[2, 0, 1], [3, 1, 0]])
    triangle, corner = triangle_around(triangles, 5)
    assert triangle[4] == -1
    np.testing.assert_array_equal(triangles[triangle[:4], corner[:4]], np.arange(4))


def test_a_vertex_without_faces_takes_the_place_of_the_nearest_without_confidence():
    loose = TriangleMesh(np.vstack([tetrahedron().vertices, 9 * tetrahedron().vertices[2]]), tetrahedron().triangles)
    analysis = analyze(loose, field=loose.vertices[:, 0])
    image = map_by_number(analysis, analysis)
    places = image.points.blend(loose.vertices, loose.triangles)
    np.testing.assert_array_equal(places, loose.vertices[[0, 1, 2, 3, 2]])
    assert image.confidence.tolist() == [1, 1, 1, 1, 0]
