"""Borders: level sets on the triangles of the input."""

from dataclasses import replace

import numpy as np
import pytest

from compute import LevelError, TriangleMesh, analyze, zero_level
from compute.segmentation.borders.level_set_borders import cross_edges
from tests.shapes import icosphere, rectangle, star, torus


@pytest.fixture(scope="module")
def tilted_star():
    """The star with the height above a tilted plane as its field: linear in space, so borders are flat."""
    mesh = star(5, 3)
    return mesh, mesh.vertices @ np.array([0.3, 1.0, 0.05])


def crossings_at(analysis, level, mode="features"):
    part_tree = analysis.part_tree()
    cuts = part_tree.cut_arcs(level, mode)
    return cross_edges(analysis.profile(), part_tree.trees, part_tree.closing_heights, cuts)


def test_a_border_lies_at_the_height_of_its_saddle(tilted_star):
    mesh, heights = tilted_star
    analysis = analyze(mesh, field=heights)
    parts = analysis.segment(level=3, mode="features").parts
    level_of_part = dict(zip(parts.id.tolist(), heights[parts.saddle].tolist(), strict=True))
    borders = analysis.borders(level=3, mode="features")
    assert {border.part for border in borders} == set(parts.id.tolist()) - {0}
    for border in borders:
        np.testing.assert_allclose(border.points @ [0.3, 1.0, 0.05], level_of_part[border.part], atol=1e-12)


@pytest.mark.parametrize("mode", ["features", "nested"])
def test_parts_of_a_sphere_with_arms_have_one_closed_border_each(mode):
    analysis = analyze(star(5, 3))
    borders = analysis.borders(mode=mode)
    assert sorted(border.part for border in borders) == [1, 2, 3, 4, 5]
    assert all(border.is_closed for border in borders)


def test_a_part_of_a_torus_has_two_borders():
    """Lying on its side, a torus has one hill, which is cut where the ring parts: two circles through the tube."""
    mesh = torus(48, 24)
    x, y, _ = mesh.vertices.T
    analysis = analyze(mesh, field=np.abs(y) + 0.1 * (y > 0) + 1e-3 * x)
    borders = [border for border in analysis.borders(level=1, mode="features") if border.part == 1]
    assert len(borders) == 2


def test_borders_of_an_open_mesh_end_at_its_boundary():
    mesh = rectangle(40, 20)
    x, y, _ = mesh.vertices.T
    analysis = analyze(mesh, field=np.cos(2 * np.pi * x) + 0.1 * y)
    assert analysis.borders()
    for border in analysis.borders():
        assert not border.is_closed
        assert set(border.points[[0, -1], 1]) <= {0.0, 1.0}


def test_crossings_of_an_edge_are_in_order_and_the_last_arc_is_that_of_the_vertex(tilted_star):
    mesh, heights = tilted_star
    analysis = analyze(mesh, field=heights)
    crossings = crossings_at(analysis, 3, "nested")
    profile = analysis.profile()
    same_edge = np.diff(crossings.edge) == 0
    assert (np.diff(crossings.parameter)[same_edge] >= 0).all()
    assert ((crossings.parameter >= 0) & (crossings.parameter <= 1)).all()
    cuts = analysis.part_tree().cut_arcs(3, "nested")
    last = np.append(~same_edge, True)
    for number, tree in enumerate(analysis.hierarchy.trees):
        part = tree.spread(cuts[number])
        at_end = profile.arcs[number][profile.edges[crossings.edge[last], 1]]
        np.testing.assert_array_equal(part[crossings.arcs[last, number]], part[at_end])


def test_a_segmentation_knows_its_borders(tilted_star):
    mesh, heights = tilted_star
    segmentation = analyze(mesh, field=heights).segment(level=2, mode="features")
    assert {border.part for border in segmentation.borders} == set(segmentation.parts.id.tolist()) - {0}


def test_the_zero_level_of_a_long_rectangle_is_its_middle():
    """The first function is the cosine of half a turn, which is zero in the middle."""
    (line,) = zero_level(analyze(rectangle(13, 4, width=3.0), n_functions=4)).borders
    np.testing.assert_allclose(line.points[:, 0], 1.5, atol=1e-3)
    assert not line.is_closed
    assert sorted(line.points[[0, -1], 1].tolist()) == [0.0, 1.0]


def test_zero_lines_bound_the_parts_above_them():
    analysis = analyze(star(5, 3), n_functions=4)
    halves = zero_level(analysis, 2)
    assert all(line.is_closed for line in halves.borders)
    positive = {
        int(part)
        for part, tip in zip(halves.parts.id, halves.parts.extremum, strict=True)
        if analysis.eigenbasis.functions[tip, 1] > 0
    }
    assert {line.part for line in halves.borders} == positive


def test_a_part_that_is_divided_further_has_borders_inside():
    mesh = star(5, 3)
    analysis = analyze(mesh, field=mesh.vertices @ np.array([0.3, 1.0, 0.05]))
    whole, finer = (analysis.segment(level=2, mode="features", within=part) for part in (None, 1))
    assert len(finer.borders) >= len(whole.borders)
    # A part too small to have a face of its own still has a line around it.
    assert {line.part for line in finer.borders} >= set(finer.parts.id.tolist()) - {0}


def test_parts_of_another_mesh_have_no_borders_inside_triangles():
    analysis = analyze(star(5, 3))
    segmentation = replace(analysis.segment(), _trace=None)
    with pytest.raises(LevelError, match="own field"):
        _ = segmentation.borders


def test_a_sphere_has_no_borders():
    assert analyze(icosphere(2)).borders() == ()


def test_unanalyzed_pieces_are_not_crossed():
    sphere = icosphere(1)
    mesh = star(5, 3)
    both = TriangleMesh(
        np.vstack([mesh.vertices, sphere.vertices * 0.1 + 20]),
        np.vstack([mesh.triangles, sphere.triangles + len(mesh.vertices)]),
    )
    analysis = analyze(both)
    crossed = np.unique(both.edges.vertices[crossings_at(analysis, analysis.hierarchy.default_level).edge])
    assert crossed.max() < len(mesh.vertices)
