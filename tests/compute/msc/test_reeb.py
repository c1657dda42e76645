"""The Reeb graph against the counts that theory gives, and against the merge trees."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from compute.msc.morse_smale import MorseSmaleComplex
from compute.msc.reeb import ReebGraph
from compute.surface.mesh import TriangleMesh
from tests.compute.msc.surfaces import annulus, closed_surface, noise, topology, waves
from tests.shapes import icosphere, joined, torus


def levels(mesh: TriangleMesh, values: np.ndarray) -> list[MorseSmaleComplex]:
    full = MorseSmaleComplex(topology(mesh, values))
    n_pairs = len(full.pairing)
    return [full.simplified(n) for n in sorted({n_pairs, n_pairs // 2, 3, 1, 0}, reverse=True)]


def n_level_set_components(mesh: TriangleMesh, values: np.ndarray, height: float) -> int:
    """Count by joining the edges that a level crosses across the triangles it crosses."""
    crossed = (values[mesh.edges.vertices] > height).sum(axis=1) == 1
    sides = mesh.edges.of_triangle[crossed[mesh.edges.of_triangle].sum(axis=1) == 2]
    left, right = np.stack([row[crossed[row]] for row in sides]).T
    n = len(crossed)
    joined_edges = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n, n))
    return len(np.unique(connected_components(joined_edges, directed=False)[1][crossed]))


def sides_of_arcs(graph: ReebGraph) -> tuple[np.ndarray, np.ndarray]:
    n = len(graph.vertex)
    return np.bincount(graph.arcs[:, 1], minlength=n), np.bincount(graph.arcs[:, 0], minlength=n)


@pytest.mark.parametrize("field", [noise, waves])
@pytest.mark.parametrize("genus", [0, 1, 2, 3])
def test_genus_g_has_g_loops_at_every_level(genus, field):
    mesh = closed_surface(genus)
    for seed in range(10):
        for found in levels(mesh, field(mesh, np.random.default_rng(seed))):
            graph = found.reeb_graph
            assert (graph.n_loops, graph.n_components) == (genus, 1)
            assert (graph.arcs[:, 0] < graph.arcs[:, 1]).all()


def test_arcs_that_pass_a_height_are_the_components_of_its_level_set():
    for mesh in (closed_surface(0), closed_surface(2), annulus(), joined(torus(12, 8), icosphere(1))):
        values = noise(mesh, np.random.default_rng(1))
        graph = levels(mesh, values)[0].reeb_graph
        low, high = values[graph.vertex[graph.arcs]].T
        for height in np.random.default_rng(2).uniform(values.min(), values.max(), 40):
            n_arcs = ((low < height) & (height < high)).sum()
            assert n_arcs == n_level_set_components(mesh, values, height)


def test_leaves_are_the_surviving_extrema_and_splits_their_saddles():
    mesh = closed_surface(0)
    for found in levels(mesh, noise(mesh, np.random.default_rng(3))):
        graph, points = found.reeb_graph, found.critical_points
        below, above = sides_of_arcs(graph)
        assert set(graph.vertex[below == 0]) == set(points.vertex[points.kind == 0])
        assert set(graph.vertex[above == 0]) == set(points.vertex[points.kind == 2])
        saddles = dict(zip(points.vertex[points.kind == 1], points.multiplicity[points.kind == 1], strict=True))
        inner = (below > 0) & (above > 0)
        assert dict(zip(graph.vertex[inner], graph.degree[inner] - 2, strict=True)) == saddles


def test_merging_saddles_of_the_graph_are_those_of_the_merge_trees():
    """Joining the arcs from below, the components merge where the merge tree says so."""
    mesh = closed_surface(2)
    values = noise(mesh, np.random.default_rng(4))
    full = levels(mesh, values)[0]
    graph, tree = full.reeb_graph, full.topology.minima
    merging = []
    group = np.arange(len(graph.vertex))
    for node in range(len(graph.vertex)):
        lower = graph.arcs[graph.arcs[:, 1] == node, 0]
        groups = np.unique(group[lower])
        merging += [graph.vertex[node]] * (len(groups) - 1)
        group[np.isin(group, groups)] = group[lower[0]] if len(lower) else node
        group[node] = group[lower[0]] if len(lower) else node
    assert sorted(merging) == sorted(tree.saddle.tolist())


def test_triangles_and_vertices_lie_on_arcs_of_their_height():
    mesh = torus(48, 24)
    values = waves(mesh, np.random.default_rng(4))
    graph = levels(mesh, values)[0].reeb_graph
    low, high = values[graph.vertex[graph.arcs]].T
    mean = values[mesh.triangles].mean(axis=1)
    assert (low[graph.arc_of_triangle] <= mean).all()
    assert (mean <= high[graph.arc_of_triangle]).all()
    inner = graph.arc_of_vertex >= 0
    assert set(np.flatnonzero(~inner)) == set(graph.vertex)
    assert (low[graph.arc_of_vertex[inner]] <= values[inner]).all()
    assert (values[inner] <= high[graph.arc_of_vertex[inner]]).all()


def test_standing_torus_is_a_ring_on_two_legs():
    mesh = torus(48, 24)
    graph = levels(mesh, mesh.vertices[:, 0] + 1e-3 * mesh.vertices[:, 1])[0].reeb_graph
    assert sorted(graph.arcs.tolist()) == [[0, 1], [1, 2], [1, 2], [2, 3]]
