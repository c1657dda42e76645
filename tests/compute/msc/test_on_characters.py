"""Topology at the end of the way from a mesh: eigenfunctions of bodies with handles."""

import numpy as np
import pytest

from compute import TriangleMesh, analyze, diagram_distance, reeb_graph
from compute.errors import LevelError
from compute.msc import reeb
from examples import handles


@pytest.fixture(scope="module")
def bitorus() -> TriangleMesh:
    body = handles(2, 1200)
    return TriangleMesh(body.vertices, body.triangles)


@pytest.fixture(scope="module")
def eighth(bitorus):
    return analyze(bitorus, field=8, order=2)


def test_eighth_eigenfunction_of_a_bitorus_has_index_sum_minus_two(eighth):
    """Reuter 2009, figure 4."""
    assert eighth.complex.euler_characteristic == -2
    assert len(eighth.complex.essential.handles) == 2


def test_reeb_graph_of_a_bitorus_has_two_loops_at_every_level(eighth):
    for level in (0, 1, eighth.hierarchy.n_levels - 1, None):
        graph = reeb_graph(eighth, level=level)
        assert graph.n_loops == 2
        assert set(graph.arc_of_triangle) <= set(range(len(graph.arcs)))


def test_level_keeps_as_many_pairs_as_its_number(eighth):
    for level in range(eighth.hierarchy.n_levels):
        found = eighth.complex_at_level(level)
        assert len(found.pairing) - found.n_cancelled == level
        assert found.euler_characteristic == -2


def test_diagram_has_the_pairs_of_the_hierarchy(eighth):
    values = eighth.field.values
    ours = eighth.diagram.points
    theirs = values[eighth.hierarchy.pairs]
    theirs = theirs[theirs[:, 0] != theirs[:, 1]]
    np.testing.assert_array_equal(ours[np.lexsort(ours.T)], theirs[np.lexsort(theirs.T)])


def test_diagram_does_not_depend_on_the_order_of_vertices_or_the_place(bitorus):
    random = np.random.default_rng(0)
    number = random.permutation(len(bitorus.vertices))
    turned = bitorus.vertices @ np.linalg.qr(random.normal(size=(3, 3)))[0] + [1, 2, 3]
    shuffled = random.permutation(number[bitorus.triangles])
    other = TriangleMesh(turned[np.argsort(number)], shuffled)
    first, second = (analyze(mesh, order=2) for mesh in (bitorus, other))
    assert diagram_distance(first.diagram, second.diagram, "bottleneck") < 1e-6 * first.field.value_range
    np.testing.assert_allclose(np.sort(first.diagram.loops, axis=0), np.sort(second.diagram.loops, axis=0), atol=1e-6)


def test_unknown_level_and_too_large_a_graph_are_refused(eighth, monkeypatch):
    with pytest.raises(LevelError, match="Level 1000 does not exist"):
        reeb_graph(eighth, level=1000)
    monkeypatch.setattr(reeb, "MOST_PIECES", 10)
    with pytest.raises(LevelError, match="choose a lower level"):
        reeb_graph(eighth, level=1)
