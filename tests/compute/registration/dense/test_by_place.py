"""By place: clothes get what the body has under them, hang over smoothly, and are told from poses."""

import numpy as np
import pytest

from compute import analyze, correspond, correspond_by_place, fill_unsure, transfer_displacements
from compute.errors import RegistrationError
from compute.surface.mesh import TriangleMesh
from tests.compute.registration.shapes import lumpy_ball, quick, shuffled
from tests.shapes import icosphere, joined, rectangle, subdivide


def tube(radius, bottom, top, *, x=0.0, n_around=24, n_along=12):
    """Return an open tube around a vertical line."""
    flat = rectangle(n_along, n_around, top - bottom, 2 * np.pi)
    along, angle = flat.vertices[:, 0], flat.vertices[:, 1]
    places = np.stack([x + radius * np.cos(angle), radius * np.sin(angle), bottom + along], axis=1)
    return TriangleMesh(places, flat.triangles)


BODY = tube(1.0, 0.0, 10.0, n_along=40)


def test_clothes_get_what_the_body_has_under_them():
    shirt = tube(1.03, 4.0, 8.0, n_around=31)
    found = correspond_by_place(BODY, shirt)
    assert found.is_sure.all()
    np.testing.assert_allclose(found.transfer(BODY.vertices[:, 2]), shirt.vertices[:, 2], atol=0.01)
    assert (np.abs(BODY.vertices[BODY.triangles[found.triangle_of_triangle], 2].mean(axis=1) - 6) < 2.3).all()


def test_what_hangs_over_goes_on_with_the_slope_of_what_lies_there():
    shirt = tube(1.03, 4.0, 8.0)
    # Its hem turns outward and away from the body.
    hem = shirt.vertices[:, 2] < 5
    out = shirt.vertices + np.where(hem, 5 - shirt.vertices[:, 2], 0)[:, None] * [1, 1, 0] * shirt.vertices
    cloth = TriangleMesh(np.where(hem[:, None], out * [1, 1, 0] + [0, 0, 5], out), shirt.triangles)
    found = correspond_by_place(BODY, cloth)
    assert 0.5 < found.overlap < 0.9
    assert not found.is_sure[np.linalg.norm(cloth.vertices[:, :2], axis=1) > 1.5].any()
    weights = found.transfer(BODY.vertices[:, 2:] / 10)
    filled = fill_unsure(found, cloth, weights)
    np.testing.assert_array_equal(filled[found.is_sure], weights[found.is_sure])
    # What is known ends at the hem with a half, and falls towards it.
    assert filled[~found.is_sure].min() > 0.49
    assert filled[~found.is_sure].max() < 0.55


def test_thick_cloth_takes_the_same_on_both_sides_and_keeps_its_own_apart():
    inner, outer = icosphere(3), icosphere(3)
    thick = joined(TriangleMesh(0.98 * inner.vertices, inner.triangles[:, ::-1]), outer)
    body = TriangleMesh(0.95 * icosphere(3).vertices, icosphere(3).triangles)
    on_body = correspond_by_place(body, thick)
    assert on_body.is_sure.all()
    np.testing.assert_array_equal(*np.split(on_body.nearest_vertex, 2))
    copy, order = shuffled(thick)
    is_outer = np.arange(len(thick.vertices)) >= len(inner.vertices)
    on_itself = correspond_by_place(thick, copy)
    np.testing.assert_array_equal(is_outer[on_itself.nearest_vertex], is_outer[order])


def test_one_leg_of_the_trousers_takes_nothing_from_the_other_leg():
    legs = joined(tube(1.0, 0, 5, x=-1.02), tube(1.0, 0, 5, x=1.02))
    trouser = tube(1.03, 0.5, 4.5, x=-1.02)
    found = correspond_by_place(legs, trouser)
    assert (legs.vertices[found.nearest_vertex, 0] < 0.01).all()


def test_doubles_along_a_seam_get_the_same():
    bent = tube(1.02, 3.0, 6.0)
    found = correspond_by_place(BODY, bent)
    _, first, place = np.unique(bent.vertices.round(9), axis=0, return_index=True, return_inverse=True)
    values = found.transfer(BODY.vertices)
    # The first and the last column of a tube lie at the same place.
    assert len(first) < len(bent.vertices)
    np.testing.assert_allclose(values, values[first[place.reshape(-1)]], atol=1e-9)


def test_displacements_stay_as_they_are():
    shirt = tube(1.03, 4.0, 8.0)
    found = correspond_by_place(BODY, shirt)
    raised = np.tile([0.0, 0.0, 0.5], (len(BODY.vertices), 1))
    np.testing.assert_allclose(transfer_displacements(found, BODY, shirt, raised)[:, 2], 0.5)


@pytest.mark.parametrize("share", [0.3, 0.5])
def test_auto_takes_a_piece_of_cloth_by_place_both_ways(share):
    body = quick(lumpy_ball(3))
    inside = body.mesh.vertices[body.mesh.triangles].mean(axis=1)[:, 2]
    chosen = body.mesh.triangles[inside > np.quantile(inside, 1 - share)]
    used, corner = np.unique(chosen, return_inverse=True)
    cloth = quick(TriangleMesh(1.01 * body.mesh.vertices[used], corner.reshape(-1, 3)[:, [1, 2, 0]]))
    assert correspond(body, cloth).found_by == "place"
    assert correspond(cloth, body).found_by == "place"
    assert correspond(body, cloth).matching is None


def test_auto_takes_the_same_surface_with_other_faces_by_place():
    corners = [[0, 0, 0], [3, 0, 0], [0, 2, 0], [0, 0, 1]]
    solid = TriangleMesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    coarse, fine = subdivide(solid), subdivide(subdivide(subdivide(solid)))
    found = correspond(analyze(coarse), analyze(fine))
    assert found.found_by == "place"
    np.testing.assert_allclose(found.transfer(coarse.vertices), fine.vertices, atol=1e-9)


def test_auto_goes_by_shape_where_a_pose_stands_on_another():
    ball = lumpy_ball(3)
    bent = ball.vertices.copy()
    bent[:, 0] += 0.1 * np.maximum(bent[:, 2] - 0.5, 0) ** 2
    found = correspond(quick(ball), quick(shuffled(TriangleMesh(bent, ball.triangles))[0]))
    assert found.found_by == "faces"


def test_methods_can_be_asked_for():
    ball, other = quick(lumpy_ball(2)), quick(lumpy_ball(3))
    assert [correspond(ball, other, method=method).found_by for method in ("place", "shape")] == ["place", "shape"]
    assert correspond(ball, ball, method="number").found_by == "number"


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"method": "faces"}, 'not by "faces"'),
        ({"method": "number"}, "whose triangles differ"),
        ({"method": "place", "points": [[0, 0]]}, "lead a map by shape, not one by place"),
    ],
)
def test_methods_that_cannot_be_are_refused(options, told):
    with pytest.raises(RegistrationError, match=told):
        correspond(quick(lumpy_ball(2)), quick(lumpy_ball(3)), **options)


def test_vertices_without_faces_are_not_sure():
    loose = TriangleMesh(np.vstack([tube(1.03, 4, 8).vertices, [[1.0, 0, 5]]]), tube(1.03, 4, 8).triangles)
    assert correspond_by_place(BODY, loose).is_sure.tolist() == [True] * (len(loose.vertices) - 1) + [False]
