"""Ranked nets and merge trees against their definitions, on complexes of every kind."""

import numpy as np
import pytest

from compute.msc.critical_points import merging_sectors
from compute.msc.links import links_of
from compute.msc.merge_tree import merge_tree
from compute.msc.ranked_net import ranked_net
from tests.compute.msc import surfaces
from tests.shapes import icosphere, joined, rectangle, torus

COMPLEXES = [
    lambda: icosphere(2),
    lambda: torus(12, 8),
    lambda: rectangle(8, 6),
    lambda: joined(icosphere(1), rectangle(4, 3)),
    lambda: surfaces.with_holes(torus(12, 8), np.random.default_rng(3), 0.4),
    surfaces.cones_sharing_their_tip,
    surfaces.three_sheets_on_an_edge,
    surfaces.sphere_with_a_wall,
]
SEEDS = range(10)


def every_net():
    """Yield a mesh, a field on it and its net for every complex, of noise, of waves and with plateaus."""
    for build in COMPLEXES:
        mesh = build()
        for seed in SEEDS:
            rng = np.random.default_rng(seed)
            steps = rng.integers(0, 4, len(mesh.vertices)).astype(float)
            for values in (surfaces.noise(mesh, rng), surfaces.waves(mesh, rng), steps):
                yield mesh, values, ranked_net(links_of(mesh.triangles, len(mesh.vertices)), values)


def slow_merges(mesh, rank):
    """Return {ended minimum: (saddle, minimum that goes on)} by adding one vertex after the other."""
    neighbours = {v: set() for v in np.unique(mesh.triangles).tolist()}
    for a, b in mesh.edges.vertices.tolist():
        neighbours[a].add(b)
        neighbours[b].add(a)
    component, merges = {}, {}
    for vertex in sorted(neighbours, key=lambda v: rank[v]):
        below = {component[w] for w in neighbours[vertex] if w in component}
        elder = min(below, key=lambda minimum: rank[minimum], default=vertex)
        for ended in below - {elder}:
            merges[ended] = vertex, elder
        component[vertex] = elder
        component = {v: elder if minimum in below else minimum for v, minimum in component.items()}
    return merges, set(component.values())


def test_the_rank_is_the_order_of_values_and_then_of_vertices():
    for _, values, net in every_net():
        order = net.vertex_at_rank.tolist()
        assert order == sorted(range(len(values)), key=lambda vertex: (values[vertex], vertex))
        np.testing.assert_array_equal(net.rank[order], np.arange(len(values)))


def test_corners_are_the_sorted_ranks_of_each_triangle():
    for mesh, _, net in every_net():
        np.testing.assert_array_equal(np.stack(net.corners, axis=1), np.sort(net.rank[mesh.triangles], axis=1))


def test_reversing_twice_gives_the_same_order_and_candidates_serve_both():
    for _, values, net in every_net():
        back = net.reversed()
        np.testing.assert_array_equal(back.reversed().rank, net.rank)
        np.testing.assert_array_equal(back.rank, len(values) - 1 - net.rank)
        # Whatever merges in either sweep is among the candidates.
        for swept in (net, back):
            assert set(merging_sectors(swept).vertex.tolist()) <= set(net.candidates.tolist())


@pytest.mark.parametrize("downwards", [False, True])
def test_merges_are_those_of_adding_one_vertex_after_the_other(downwards):
    for mesh, _, net in every_net():
        swept = net.reversed() if downwards else net
        tree = merge_tree(swept)
        merges, roots = slow_merges(mesh, swept.rank)
        saddle_of = dict(zip(tree.extremum.tolist(), tree.saddle.tolist(), strict=True))
        elder_of = dict(zip(tree.extremum.tolist(), tree.elder.tolist(), strict=True))
        # Where more than two components meet they are joined one after the other, at one saddle.
        for extremum, saddle in saddle_of.items():
            while saddle_of.get(elder_of[extremum]) == saddle:
                elder_of[extremum] = elder_of[elder_of[extremum]]
        assert {extremum: (saddle, elder_of[extremum]) for extremum, saddle in saddle_of.items()} == merges
        assert set(tree.roots.tolist()) == roots


def test_pairs_stand_in_the_order_of_the_sweep_and_descents_lead_down_to_the_minima():
    for mesh, _, net in every_net():
        tree = merge_tree(net)
        assert (np.diff(net.rank[tree.saddle]) >= 0).all()
        used = np.unique(mesh.triangles)
        goes_down = tree.descent[used] != used
        assert (net.rank[tree.descent[used]] < net.rank[used])[goes_down].all()
        assert set(tree.basin[used].tolist()) == {*tree.extremum.tolist(), *tree.roots.tolist()}
