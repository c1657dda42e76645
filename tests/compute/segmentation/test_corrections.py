"""Corrections on branches and on the relief of a field."""

import numpy as np
import pytest

from compute import analyze
from compute.segmentation.borders.edge_profile import vertex_heights
from compute.segmentation.edits.corrections import (
    AWAY,
    BEFORE,
    BEYOND,
    LEVEL,
    MERGE,
    MOVE,
    PAINT,
    SPLIT,
    Correction,
    Corrections,
    Labelling,
    corrected,
)
from compute.segmentation.edits.part_tracking import carried, renumbered, tracked_parts
from compute.segmentation.edits.redrawing import redraw, undivided
from compute.segmentation.edits.relief import relief_of
from compute.segmentation.faces.branches import Branches
from compute.segmentation.faces.face_graph import face_graph
from compute.segmentation.parts.part_labels import label_branches, listed_parents
from compute.surface.mesh import TriangleMesh
from tests.compute.test_analysis import n_pieces
from tests.shapes import star


def row_of_branches(n):
    """Return n branches of area 1 in a row."""
    pairs = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    return Branches(
        np.arange(n, dtype=np.int32), *2 * [np.arange(n)], np.ones(n), np.ones(n, int), pairs, np.ones(n - 1)
    )


def correct(labels, parent, items, side=None, painted=None):
    n = len(labels)
    side = np.full((len(items), n), AWAY) if side is None else np.array([side] * len(items))
    painted = np.full(n, -1) if painted is None else np.array(painted)
    done = corrected(
        Labelling(np.array(labels), np.array(parent)), row_of_branches(n), Corrections(tuple(items), side, painted)
    )
    return done.of_branch.tolist(), done.parent.tolist(), done.resting


def test_a_merged_part_leaves_its_children_to_the_other():
    labels, parent, resting = correct([0, 1, 2, 3], [0, 0, 1, 2], [Correction(MERGE, 2, other=1)])
    assert labels == [0, 1, 1, 3]
    assert parent[3] == 1
    assert resting == ()


def test_a_parent_that_joins_its_child_leaves_it_its_own_parent():
    labels, parent, _ = correct([0, 1, 2], [0, 0, 1], [Correction(MERGE, 1, other=2)])
    assert labels == [0, 2, 2]
    assert parent[2] == 0


def test_a_part_that_joins_what_grows_out_of_its_child_goes_round_in_no_ring():
    labels, parent, _ = correct([0, 2, 1, 3], [0, 0, 1, 2], [Correction(MERGE, 1, other=3)])
    assert labels == [0, 2, 3, 3]
    assert (parent[3], parent[2]) == (0, 3)


def test_parents_without_faces_are_passed_over():
    parent = np.array([0, 0, 1, 2, 3, 6, 5])
    assert listed_parents(parent, np.array([0, 1, 4, 6]))[[1, 4]].tolist() == [0, 1]
    # What goes round in a ring grows out of nothing.
    assert listed_parents(parent, np.array([4]))[5] == 0


def test_parts_that_do_not_touch_are_not_merged():
    assert correct([1, 0, 2], [0, 0, 0], [Correction(MERGE, 1, other=2)]) == ([1, 0, 2], [0, 0, 0], (0,))


def test_corrections_are_applied_in_their_order():
    first, second = Correction(MERGE, 2, other=1), Correction(MERGE, 1, other=0)
    assert correct([0, 1, 2], [0, 0, 1], [first, second])[0] == [0, 0, 0]
    assert correct([0, 1, 2], [0, 0, 1], [second, first])[0] == [0, 0, 2]


def test_a_split_gives_children_to_the_side_they_touch():
    split = Correction(SPLIT, 1, other=9)
    labels, parent, _ = correct([2, 1, 1, 3, 0], [0, 0, 1, 1], [split], side=[BEYOND, BEYOND, BEFORE, BEFORE, AWAY])
    assert labels == [2, 9, 1, 3, 0]
    assert (parent[2], parent[3], parent[9]) == (9, 1, 1)


def test_a_split_of_all_or_nothing_rests():
    assert correct([0, 1, 1], [0, 0], [Correction(SPLIT, 1, other=5)], side=[AWAY, BEYOND, BEYOND])[2] == (0,)
    assert correct([0, 1, 1], [0, 0], [Correction(SPLIT, 1, other=5)], side=[AWAY, BEFORE, BEFORE])[2] == (0,)


def test_a_moved_border_takes_from_the_parent_alone_and_leaves_joined_parts_their_faces():
    move = Correction(MOVE, 1)
    assert correct([0, 0, 1, 2], [0, 0, 0], [move], side=[AWAY, BEYOND, BEYOND, BEYOND])[0] == [0, 1, 1, 2]
    assert correct([1, 0, 1, 1], [0, 0], [move], side=[AWAY, AWAY, BEFORE, BEYOND])[0] == [0, 0, 0, 1]
    # The stray piece that the border cut off has joined the body.


def test_painting_comes_last_and_stays_as_it_was_painted():
    items = [Correction(PAINT, 2), Correction(MERGE, 1, other=0)]
    labels, _, resting = correct([0, 1, 2, 0, 0], [0, 0, 1], items, painted=[2, -1, -1, -1, -1])
    assert labels == [2, 0, 2, 0, 0]
    assert resting == ()


def test_painting_rests_where_its_part_is_missing_unless_it_is_the_part():
    painted = [5, -1, -1]
    assert correct([0, 0, 1], [0, 0], [Correction(PAINT, 5)], painted=painted)[::2] == ([0, 0, 1], (0,))
    assert correct([0, 0, 1], [0, 0], [Correction(PAINT, 5, other=1)], painted=painted)[0] == [5, 0, 1]


@pytest.fixture(scope="module")
def arms():
    """A star with linear elements, so that the field is linear on its own triangles."""
    analysis = analyze(star(5, 3), order=1)
    return analysis, vertex_heights(analysis.surface, analysis.field)


def redrawn(analysis, heights, items, level, painted=None):
    """Return the labels of the triangles with some corrections."""
    own = np.arange(len(analysis.mesh.triangles))
    graph = face_graph(analysis.mesh, analysis.surface, own)
    painted = np.full(len(own), -1) if painted is None else painted
    relief = relief_of(analysis.surface, heights, own, graph.stands_for)
    part_tree, corrections = redraw(analysis.part_tree(), items, painted, relief, graph)
    labels = label_branches(part_tree, level=level, mode="features", corrections=corrections)
    return labels.of_faces(part_tree), labels


def test_a_border_follows_the_level_it_is_moved_to(arms):
    analysis, heights = arms
    before = analysis.segment(mode="features")
    move = Correction(MOVE, 2, value=-0.2, level=before.level, mode="features")
    moved, _ = redrawn(analysis, heights, (move,), before.level)
    saddle = before.parts.saddle[before.parts.id.tolist().index(2)]
    border = heights[saddle] + 0.2 * analysis.hierarchy.value_range
    mean = heights[analysis.mesh.triangles].mean(axis=1)
    np.testing.assert_array_equal(moved, np.where((before.labels == 2) & (mean <= border), 0, before.labels))


def test_a_border_moved_outward_stops_where_the_next_hill_begins(arms):
    analysis, heights = arms
    before = analysis.segment(mode="features")
    move = Correction(MOVE, 2, value=0.9, level=before.level, mode="features")
    moved, _ = redrawn(analysis, heights, (move,), before.level)
    for other in (1, 3, 4, 5):
        np.testing.assert_array_equal(moved == other, before.labels == other)
    assert 1.2 * (before.labels == 2).sum() < (moved == 2).sum() < 0.5 * len(moved)
    assert n_pieces(analysis.mesh, moved == 2) == 1


def test_every_face_has_a_label_and_areas_add_up(arms):
    analysis, heights = arms
    level = analysis.hierarchy.default_level
    items = (Correction(SPLIT, 3, other=50, value=0.2, level=level, mode="features"),)
    labels, done = redrawn(analysis, heights, items, level)
    assert {3, 50} <= set(labels.tolist())
    np.testing.assert_allclose(np.bincount(labels, analysis.mesh.areas)[done.parts.id], done.parts.area)
    assert done.parts.parent[done.parts.id.tolist().index(50)] == 3


@pytest.fixture(scope="module")
def two_orders():
    """Parts are tracked by their exact faces, wherever borders are shown."""
    mesh = star(5, 3)
    return analyze(mesh, order=1, borders="exact"), analyze(mesh, order=3, borders="exact")


def test_no_corrections_change_nothing(two_orders):
    analysis = two_orders[0]
    for level in range(analysis.hierarchy.n_levels):
        plain = label_branches(analysis.part_tree(), level=level, mode="nested")
        none = undivided(analysis.part_tree(), ())
        same = label_branches(analysis.part_tree(), level=level, mode="nested", corrections=none)
        np.testing.assert_array_equal(plain.of_branch, same.of_branch)


def test_parts_are_found_again_in_another_analysis(two_orders):
    old, new = (analysis.part_tree() for analysis in two_orders)
    labels = [a.segment(mode="nested") for a in two_orders]
    items = tuple(Correction(LEVEL, part, value=3.0, level=labels[0].level) for part in labels[0].parts.id[1:].tolist())
    found = carried(items, old, new, two_orders[0].mesh.areas)
    for item, again in zip(items, renumbered(items, found, old.hierarchy, new.hierarchy), strict=True):
        both = (labels[0].labels == item.part) & (labels[1].labels == again.part)
        assert both.sum() > 0.9 * (labels[0].labels == item.part).sum()
        assert again.value == 3.0


def test_parts_are_tracked_to_where_most_of_their_faces_are(two_orders):
    old, new = (analysis.part_tree() for analysis in two_orders)
    labels = [analysis.segment() for analysis in two_orders]
    ids = labels[0].parts.id.tolist()
    area = two_orders[0].mesh.areas
    assert tracked_parts(ids, old, old, area, "nested") == {part: part for part in ids}
    tracked = tracked_parts(ids, old, new, area, "nested")
    assert set(tracked) == set(ids)
    for part, again in tracked.items():
        both = (labels[0].labels == part) & (labels[1].labels == again)
        assert both.sum() > 0.9 * (labels[0].labels == part).sum()


def test_a_part_that_is_not_there_any_more_is_not_found(two_orders):
    old, mesh = two_orders[0].part_tree(), two_orders[0].mesh
    flat = analyze(TriangleMesh(mesh.vertices, mesh.triangles), field=np.ones(len(mesh.vertices)))
    new = flat.part_tree()
    items = (Correction(LEVEL, 2, value=3.0, level=old.hierarchy.default_level),)
    assert renumbered(items, carried(items, old, new, mesh.areas), old.hierarchy, new.hierarchy) == ()
