"""The dense map: exact where the faces are the same, close to the truth where they are not."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from compute import TriangleMesh, correspond, match, register
from compute.errors import RegistrationError
from tests.compute.registration.shapes import moved, quick, shuffled
from tests.shapes import icosphere, joined, tetrahedron


def test_a_mesh_goes_to_itself_by_number(ball):
    found = correspond(ball, ball)
    assert found.found_by == "number"
    np.testing.assert_array_equal(found.transfer(ball.mesh.vertices), ball.mesh.vertices)
    np.testing.assert_array_equal(found.transfer_faces(np.arange(len(ball.mesh.triangles))), np.arange(320))
    assert (found.confidence == 1).all()


def test_shuffled_and_moved_it_goes_to_itself_to_round_off(ball):
    other, order = shuffled(moved(ball.mesh))
    found = correspond(ball, quick(other))
    assert found.found_by == "faces"
    np.testing.assert_allclose(found.transfer(ball.mesh.vertices), ball.mesh.vertices[order], atol=1e-12)
    assert len(np.unique(found.nearest_vertex)) == len(order)


def test_shuffled_and_bent_every_triangle_finds_itself(ball):
    bent = TriangleMesh(ball.mesh.vertices + 0.1 * np.sin(ball.mesh.vertices[:, [1, 2, 0]]), ball.mesh.triangles)
    other, order = shuffled(bent, seed=4)
    found = correspond(ball, quick(other))
    corners = np.sort(ball.mesh.triangles[found.triangle_of_triangle], axis=1)
    np.testing.assert_array_equal(corners, np.sort(order[other.triangles], axis=1))


def test_coordinates_are_convex(to_finer):
    np.testing.assert_allclose(to_finer.barycentric.sum(axis=1), 1, atol=1e-12)
    assert to_finer.barycentric.min() >= 0


def test_constants_stay_constant(to_finer, ball):
    np.testing.assert_allclose(to_finer.transfer(np.full((len(ball.mesh.vertices), 2), 7.0)), 7, rtol=1e-14)


def test_a_linear_function_is_its_value_at_the_place(to_finer, ball):
    slope = np.array([0.3, -1.2, 0.5])
    places = to_finer.transfer(ball.mesh.vertices)
    np.testing.assert_allclose(to_finer.transfer(ball.mesh.vertices @ slope), places @ slope, atol=1e-12)


def test_vertices_land_where_they_lie_on_a_copy_with_other_triangles(to_finer, ball, finer):
    away = np.linalg.norm(to_finer.transfer(ball.mesh.vertices) - finer.mesh.vertices, axis=1)
    assert away.mean() < 0.02 * np.sqrt(finer.mesh.areas.sum())
    assert to_finer.found_by == "shape"


def test_there_and_back_is_where_it_began(to_finer, to_ball, ball):
    back = to_ball.transfer(to_finer.transfer(ball.mesh.vertices))
    assert np.linalg.norm(back - ball.mesh.vertices, axis=1).mean() < 0.03 * np.sqrt(ball.mesh.areas.sum())


def test_labels_come_from_the_nearest_vertex_and_the_middle_of_the_face(to_finer, ball, finer):
    upper = ball.mesh.vertices[:, 2] > 0
    clear = np.abs(finer.mesh.vertices[:, 2]) > 0.4
    assert (to_finer.transfer_labels(upper) == (finer.mesh.vertices[:, 2] > 0))[clear].mean() > 0.99
    middles = [mesh.vertices[mesh.triangles].mean(axis=1)[:, 2] for mesh in (ball.mesh, finer.mesh)]
    clear = np.abs(middles[1]) > 0.4
    assert (to_finer.transfer_faces(middles[0] > 0) == (middles[1] > 0))[clear].mean() > 0.99


def test_a_mirror_image_is_found_when_told(ball):
    mirrored = TriangleMesh(ball.mesh.vertices * [-1, 1, 1], ball.mesh.triangles[:, ::-1])
    other, order = shuffled(mirrored, seed=2)
    target = quick(other)
    found = correspond(ball, target, matching=match(ball, target, mirrored=True))
    np.testing.assert_allclose(found.transfer(ball.mesh.vertices), ball.mesh.vertices[order], atol=1e-12)


def test_loose_parts_follow_what_is_next_to_them_without_confidence(ball):
    speck = TriangleMesh(icosphere(0).vertices * 0.05 + [0, 0, 9], icosphere(0).triangles)
    target = quick(joined(shuffled(ball.mesh)[0], speck))
    found = correspond(ball, target)
    loose = np.arange(len(found.confidence)) >= len(ball.mesh.vertices)
    assert (found.confidence[loose] == 0).all()
    nearest = cKDTree(target.mesh.vertices[~loose]).query(target.mesh.vertices[loose])[1]
    np.testing.assert_array_equal(found.nearest_vertex[loose], found.nearest_vertex[~loose][nearest])


def test_a_matching_of_other_shapes_is_refused(ball, finer):
    tiny = quick(tetrahedron())
    with pytest.raises(RegistrationError, match="other shapes"):
        correspond(ball, tiny, matching=match(ball, finer))


def test_repeated_faces_do_not_shift_the_numbers_of_the_others(ball):
    again = TriangleMesh(ball.mesh.vertices, np.vstack([ball.mesh.triangles[:1], ball.mesh.triangles]))
    for source, target in ((quick(again), ball), (ball, quick(again))):
        found = correspond(source, target)
        assert found.found_by == "number"
        np.testing.assert_allclose(found.transfer(source.mesh.vertices), target.mesh.vertices, atol=1e-12)
        images = source.mesh.triangles[found.triangle_of_triangle]
        np.testing.assert_array_equal(np.sort(images), np.sort(target.mesh.triangles))


def test_registered_shapes_with_other_repeated_faces_have_a_label_for_each(ball):
    again = quick(TriangleMesh(ball.mesh.vertices, np.vstack([ball.mesh.triangles, ball.mesh.triangles[[5, 7]]])))
    assert [len(result.labels) for result in register([ball, again])] == [320, 322]
