import numpy as np

from compute.segmentation.faces.arc_areas import ArcAreas
from compute.segmentation.faces.branches import Branches, build_branches, repaired_labels
from compute.segmentation.faces.face_graph import FaceGraph

# Arcs 0 and 1 close at 2, arcs 2 and 3 at 4.
PARENT = np.array([2, 2, 4, 4, -1])


def row_of_faces(n):
    """Return the graph of n faces of area 1 in a row."""
    pairs = np.stack([np.arange(n - 1), np.arange(1, n)], axis=1)
    return FaceGraph(np.ones(n), np.arange(n), pairs, np.ones(n - 1), np.arange(n - 1))


def test_a_face_goes_to_the_innermost_arc_whose_subtree_holds_more_than_half():
    face = np.array([0, 0, 0, 1, 1, 1])
    arc = np.array([0, 1, 4, 0, 1, 2])
    area = np.array([0.3, 0.3, 0.4, 0.2, 0.6, 0.2])
    (branches,) = build_branches([PARENT], [ArcAreas(face, arc, area)], row_of_faces(2))
    assert branches.arc[branches.of_face].tolist() == [2, 1]


def test_half_a_face_is_not_enough():
    shares = ArcAreas(np.array([0, 0]), np.array([0, 2]), np.array([0.5, 0.5]))
    (branches,) = build_branches([PARENT], [shares], row_of_faces(1))
    assert branches.arc[branches.of_face].tolist() == [2]


def test_an_arc_in_two_pieces_is_two_branches():
    arc = np.array([0, 4, 0, 0])
    (branches,) = build_branches([PARENT], [ArcAreas(np.arange(4), arc, np.ones(4))], row_of_faces(4))
    assert branches.arc[branches.of_face].tolist() == arc.tolist()
    assert len(branches.arc) == 3
    assert len(branches.borders) == 2
    assert sorted(branches.area) == [1, 1, 2]


def test_faces_that_are_not_analyzed_share_the_fate_of_the_face_they_lie_on():
    graph = row_of_faces(3)
    graph = FaceGraph(graph.area, np.array([0, 1, 0]), graph.neighbours[:1], graph.length[:1], graph.shared[:1])
    (branches,) = build_branches([PARENT], [ArcAreas(np.array([0, 1]), np.array([0, 4]), np.ones(2))], graph)
    assert branches.of_face[2] == branches.of_face[0] != branches.of_face[1]
    assert branches.n_faces[branches.of_face[0]] == 2


def pieces(area, borders, length):
    n = len(area)
    return Branches(
        np.arange(n, dtype=np.int32), *2 * [np.arange(n)], np.array(area, float), np.ones(n, int), borders, length
    )


def test_a_stray_piece_joins_the_neighbour_it_shares_most_border_with():
    # Branch 2 has the label of branch 0 and touches 1 and 3 only.
    borders, length = np.array([[0, 1], [1, 2], [2, 3]]), np.array([1.0, 2.0, 3.0])
    repaired = repaired_labels(np.array([5, 6, 5, 0]), pieces([9, 9, 1, 9], borders, length))
    assert repaired.tolist() == [5, 6, 0, 0]


def test_the_largest_piece_keeps_the_label():
    borders, length = np.array([[0, 1], [1, 2]]), np.ones(2)
    assert repaired_labels(np.array([5, 0, 5]), pieces([1, 9, 2], borders, length)).tolist() == [0, 0, 5]


def test_the_body_may_be_in_pieces():
    borders, length = np.array([[0, 1], [1, 2]]), np.ones(2)
    assert repaired_labels(np.array([0, 5, 0]), pieces([1, 9, 2], borders, length)).tolist() == [0, 5, 0]


def test_the_pieces_of_two_trees_lie_on_one_arc_of_each():
    first, second = np.array([0, 0, 4, 4]), np.array([4, 1, 1, 4])
    shares = [ArcAreas(np.arange(4), arc, np.ones(4)) for arc in (first, second)]
    branches = build_branches([PARENT, PARENT], shares, row_of_faces(4))
    assert len(branches[0].arc) == 4
    np.testing.assert_array_equal(branches[0].of_face, branches[1].of_face)
    np.testing.assert_array_equal(branches[0].arc[branches[0].of_face], first)
    np.testing.assert_array_equal(branches[1].arc[branches[1].of_face], second)
