"""A vertex that no face uses changes nothing, wherever it is."""

from functools import cache

import numpy as np
import pytest

from compute import (
    TriangleMesh,
    analyze,
    binding_weights,
    correspond,
    fill_unsure,
    mirror_parts,
    reeb_graph,
    register,
    skeleton,
    zero_level,
)
from tests.shapes import star

STAR = star(n_arms=4, n_subdivisions=2)
NOWHERE = [(np.nan, 1e300), (np.inf, 50.0)]


def with_loose(first, last):
    """Return the star with a loose vertex in front of all others and one behind them."""
    return TriangleMesh(np.vstack([[[first] * 3], STAR.vertices, [[last] * 3]]), STAR.triangles + 1)


@cache
def analyzed(*places):
    """Return the analysis of the star, with loose vertices if there are places for them."""
    return analyze(with_loose(*places) if places else STAR, order=1)


READINGS = {
    "parts": lambda analysis: analysis.segment().labels,
    "borders": lambda analysis: np.concatenate([line.points for line in analysis.segment().borders]),
    "joints": lambda analysis: skeleton(analysis).joints,
    "graph": lambda analysis: reeb_graph(analysis).arcs,
    "halves": lambda analysis: zero_level(analysis).labels,
    "twins": lambda analysis: mirror_parts(analysis, analysis.segment().labels),
}


@pytest.mark.parametrize("places", NOWHERE)
@pytest.mark.parametrize("name", READINGS)
def test_nothing_that_is_read_from_an_analysis_changes(name, places):
    np.testing.assert_array_equal(READINGS[name](analyzed(*places)), READINGS[name](analyzed()))


@pytest.mark.parametrize("places", NOWHERE)
def test_weights_stay_and_loose_vertices_move_with_some_bone(places):
    analysis = analyzed(*places)
    weights = binding_weights(analysis, skeleton(analysis))
    alone = analyzed()
    np.testing.assert_array_equal(weights[1:-1], binding_weights(alone, skeleton(alone)))
    np.testing.assert_allclose(weights.sum(axis=1), 1)


def test_a_map_to_or_from_the_others_stays_exact():
    loose, alone = analyzed(*NOWHERE[0]), analyzed()
    there, back = correspond(alone, loose, method="shape"), correspond(loose, alone, method="shape")
    assert (there.found_by, back.found_by) == ("faces", "faces")
    np.testing.assert_allclose(there.transfer(STAR.vertices)[1:-1], STAR.vertices, atol=1e-12)
    np.testing.assert_allclose(back.transfer(loose.mesh.vertices), STAR.vertices, atol=1e-12)
    assert (there.confidence[[0, -1]] == 0).all()
    assert np.isfinite(fill_unsure(there, loose.mesh, there.transfer(STAR.vertices))).all()


def test_registered_parts_stay():
    loose, alone = analyzed(*NOWHERE[0]), analyzed()
    first, second = register([loose, alone])
    np.testing.assert_array_equal(first.labels, second.labels)


def test_a_field_of_the_users_may_be_anything_where_no_face_is():
    heights = np.linalg.norm(STAR.vertices, axis=1)
    found = analyze(with_loose(np.nan, np.nan), field=np.concatenate([[np.nan], heights, [np.inf]]))
    expected = analyze(STAR, field=heights)
    np.testing.assert_array_equal(skeleton(found).joints, skeleton(expected).joints)
    np.testing.assert_array_equal(found.segment().labels, expected.segment().labels)


def test_a_pose_may_be_anything_where_no_face_is():
    analysis, alone = analyzed(*NOWHERE[0]), analyzed()
    pose = analysis.mesh.vertices * [1, 1, 2]
    pose[[0, -1]] = np.inf
    posed, expected = skeleton(analysis, poses=[pose]), skeleton(alone, poses=[STAR.vertices * [1, 1, 2]])
    np.testing.assert_array_equal(posed.joints, expected.joints)


def test_the_extent_of_a_mesh_is_that_of_its_faces():
    np.testing.assert_array_equal(np.ptp(with_loose(np.nan, 1e300).vertices, axis=0), np.ptp(STAR.vertices, axis=0))
