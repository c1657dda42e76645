"""Graphs cleared of what is no limb."""

import numpy as np

from compute.msc.reeb import ReebGraph
from compute.skeletons.branching import chains_between
from tests.compute.skeletons.shapes import chain, slices_of


def graph(n_nodes, arcs) -> ReebGraph:
    return ReebGraph(np.arange(n_nodes), np.array(arcs), np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))


def as_sets(chains):
    return {(frozenset([found.start, found.end]), frozenset(found.slices.tolist())) for found in chains}


def test_a_chain_reversed_runs_from_its_end():
    turned = chain(3, 7, 1, 2, 4).reversed()
    assert (turned.start, turned.end, turned.slices.tolist()) == (7, 3, [4, 2, 1])


def test_leaves_that_are_no_tips_are_taken_off_and_what_they_parted_is_joined():
    """Tips 0, 3, 4 around node 2; the spur 1-5 makes no hub of node 1."""
    arcs = [[0, 1], [1, 2], [2, 3], [2, 4], [1, 5]]
    found = chains_between(graph(6, arcs), slices_of([2, 2, 1, 1, 3]), {0, 3, 4})
    expected = {
        (frozenset([0, 2]), frozenset([0, 1, 2, 3])),
        (frozenset([2, 3]), frozenset([4])),
        (frozenset([2, 4]), frozenset([5])),
    }
    assert as_sets(found) == expected


def test_slices_of_a_joined_chain_follow_one_another():
    (found,) = chains_between(graph(3, [[0, 1], [1, 2]]), slices_of([2, 3]), {0, 2})
    line = found.slices.tolist()
    assert line in ([0, 1, 2, 3, 4], [4, 3, 2, 1, 0])
    assert (found.start, found.end) == ((0, 2) if line[0] == 0 else (2, 0))


def test_loops_stay():
    arcs = [[0, 1], [1, 2], [1, 2], [2, 3]]
    found = chains_between(graph(4, arcs), slices_of([1, 2, 2, 1]), {0, 3})
    assert len(found) == 4


def test_an_arc_without_slices_is_one_node_with_its_other_end():
    arcs = [[0, 1], [1, 2], [2, 3], [2, 4]]
    found = chains_between(graph(5, arcs), slices_of([1, 0, 1, 1]), {0, 3, 4})
    assert len(found) == 3
    assert len({node for one in found for node in (one.start, one.end)} - {0, 3, 4}) == 1
