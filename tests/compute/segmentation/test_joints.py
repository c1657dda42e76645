"""Joints: limbs cut where they narrow on both sides, the strongest first, twins together, and nothing else changes."""

from dataclasses import replace

import numpy as np
import pytest

from compute import READINGS, LevelError, TriangleMesh, analyze, label_branches, skeleton
from compute.segmentation.faces.part_tree import PartTree
from compute.segmentation.hierarchy.measured_hierarchy import measured_hierarchy
from compute.segmentation.hierarchy.necks import Necks
from compute.surface.mesh import connected_pieces
from examples import humanoid
from tests.shapes import lathe

POSES = ["rest", "walk"]


def bone(*depths, n_around=24, n_along=160, length=8.0):
    """Return a rod of radius 1 along z with a dent near each end for each depth, at 5, 6, ... from its middle."""
    z = np.linspace(-length, length, n_along)
    radius = np.sqrt(np.maximum(1 - np.maximum(np.abs(z) - length + 1, 0) ** 2, 1e-4))
    for place, depth in enumerate(depths):
        radius -= depth * np.exp(-(((np.abs(z) - 5 + 2 * place) / 0.5) ** 2))
    return lathe(np.stack([radius, z], axis=1), n_around)


def triangles_of(quads):
    return np.vstack([quads[:, :3], quads[:, [0, 2, 3]]])


@pytest.fixture(scope="module")
def character():
    return humanoid(6000)


@pytest.fixture(scope="module", params=POSES)
def analysis(character, request):
    return analyze(TriangleMesh(character.mesh_in_pose(request.param), triangles_of(character.quads)), order=1)


def heights_of(mesh):
    return mesh.vertices[mesh.triangles, 2].mean(axis=1)


def test_a_limb_is_cut_at_its_narrowest_place():
    mesh = bone(0.4)
    analysis = analyze(mesh)
    without, parts = analysis.segment(joints=False), analysis.segment()
    assert (without.n_parts, parts.n_parts) == (1, 3)
    assert without.warnings
    assert not parts.warnings
    for end in (-1, 1):
        tip = int(parts.labels[np.argmax(end * heights_of(mesh))])
        inside = heights_of(mesh)[parts.labels == tip]
        assert np.abs(inside).min() == pytest.approx(5, abs=0.25)


def test_a_rod_without_dents_has_no_joints():
    analysis = analyze(bone())
    for level in range(analysis.hierarchy.n_levels):
        np.testing.assert_array_equal(
            analysis.segment(level=level).labels, analysis.segment(level=level, joints=False).labels
        )


def test_the_deeper_of_two_dents_comes_first():
    analysis = analyze(bone(0.1, 0.4))
    (tree,) = analysis.hierarchy.trees
    strongest = tree.saddle[np.argsort(tree.neck + np.where(tree.is_neck, 0, len(tree.neck)))]
    places = np.abs(analysis.net.positions[strongest[: tree.n_necks], 2])
    np.testing.assert_allclose(places, [3, 3, 5, 5], atol=0.3)
    assert tree.neck_closing[tree.neck == 0] < tree.neck_closing[tree.neck == 3]


def test_what_a_neck_cuts_off_is_slender(monkeypatch):
    """A plate on a stick with a groove round it is wider than long beyond the groove: that is no joint."""
    z = np.linspace(-8, 1.2, 260)
    radius = np.where(z < 0, 0.6, 0) + 2 * np.sqrt(np.clip(1 - (z - 0.2) ** 2, 0, 1))
    grooved = radius * (1 - 0.3 * np.exp(-(((z - 0.35) / 0.12) ** 2)))
    mesh = lathe(np.stack([np.maximum(grooved, 0.02), z], axis=1), 24)
    assert not analyze(mesh).hierarchy.trees[0].is_neck.any()
    monkeypatch.setattr("compute.segmentation.hierarchy.necks.SLENDER", np.inf)
    assert analyze(mesh).hierarchy.trees[0].is_neck.any()


def test_all_is_as_it_was_for_those_who_ask_for_none(analysis, monkeypatch):
    """The same labels at every level as if no neck had been looked for."""
    nothing = np.zeros(0, dtype=np.int64)
    none = Necks(nothing, nothing, np.zeros(0), nothing, nothing)
    monkeypatch.setattr("compute.segmentation.hierarchy.divided_arcs.find_necks", lambda *_: none)
    hierarchy, arcs, measures = measured_hierarchy(
        analysis.surface, analysis.field, analysis._topology, analysis.eigenbasis, ends_at_handles=False
    )
    plain = replace(analysis, hierarchy=hierarchy, measures=measures, _arc_of_vertex=arcs)
    assert analysis.hierarchy.trees[0].is_neck.any()
    for mode in ("nested", "features"):
        for level in range(hierarchy.n_levels):
            ours, theirs = (one.segment(level=level, mode=mode, joints=False) for one in (analysis, plain))
            np.testing.assert_array_equal(ours.labels, theirs.labels)
            np.testing.assert_array_equal(ours.parts.id, theirs.parts.id)


def inside(tree: PartTree, level, reading):
    return label_branches(tree, level=level, mode=reading).of_faces(tree)


def refines(fine, coarse):
    """Whether each part of a division lies in one part of another."""
    return len(np.unique(np.stack([fine, coarse]), axis=1).T) == len(np.unique(fine))


def test_joints_only_divide_parts_further(analysis):
    tree = analysis.part_tree().exact
    for level in range(analysis.hierarchy.n_levels):
        assert refines(inside(tree, level, "jointed"), inside(tree, level, "nested"))


def test_a_part_keeps_its_number_at_every_level(analysis):
    """What a joint cuts off has the same tip at all levels, and no other part has its number."""
    tips = {}
    for level in range(analysis.hierarchy.n_levels):
        parts = analysis.segment(level=level, joints=True).parts
        assert len(np.unique(parts.id)) == len(parts.id)
        for part, tip in zip(
            parts.id[parts.saddle < 0].tolist(), parts.extremum[parts.saddle < 0].tolist(), strict=True
        ):
            assert tips.setdefault(part, tip) == tip


def test_twins_have_joints_at_corresponding_places(analysis):
    (tree,) = analysis.hierarchy.trees
    necks = np.flatnonzero(tree.is_neck)
    np.testing.assert_array_equal(tree.twin[tree.twin[necks]], necks)
    np.testing.assert_array_equal(tree.neck_closing[tree.twin[necks]], tree.neck_closing[necks])
    assert (tree.twin[necks] != necks).any()


def test_a_joint_waits_for_its_limb(analysis):
    (tree,) = analysis.hierarchy.trees
    for level in range(analysis.hierarchy.default_level):
        cut = analysis.part_tree().cut_arcs(level, "jointed")[0]
        for arc in np.flatnonzero(tree.is_neck & (cut > 0)).tolist():
            around = arc
            while tree.is_neck[around] or not tree.is_feature(analysis.hierarchy.default_level)[around]:
                around = int(tree.parent[around])
            assert cut[around] > 0


def test_the_number_of_parts_can_be_asked_for():
    analysis = analyze(bone(0.4))
    assert analysis.segment(n_parts=3).n_parts == 3
    assert analysis.segment(n_parts=3, joints=False).n_parts < 3


def test_joints_among_features_are_refused(analysis):
    with pytest.raises(LevelError, match="nested parts only"):
        analysis.segment(mode="features", joints=True)
    with pytest.raises(LevelError, match="nested parts only"):
        analysis.borders(mode="features", joints=True)


def test_borders_run_along_the_level_sets_of_necks():
    analysis = analyze(bone(0.4))
    parts = analysis.segment(joints=True)
    at_joints = [line for line in parts.borders if line.part in parts.parts.id[(parts.parts.saddle < 0)]]
    assert len(at_joints) == 2
    for line in at_joints:
        np.testing.assert_allclose(np.abs(line.points[:, 2]), 5, atol=0.25)
        assert line.is_closed


def test_bones_can_end_at_joints(analysis):
    labels = analysis.segment(joints=True).labels
    assert set(skeleton(analysis, labels=labels).part.tolist()) <= set(labels.tolist())


@pytest.mark.parametrize("reading", READINGS)
def test_every_part_is_in_one_piece(analysis, reading):
    tree = analysis.part_tree()
    branches = tree.branches[0]
    for level in range(analysis.hierarchy.n_levels):
        of_branch = label_branches(tree, level=level, mode=reading).of_branch
        same = branches.borders[of_branch[branches.borders[:, 0]] == of_branch[branches.borders[:, 1]]]
        pieces = connected_pieces(*same.T, len(of_branch))
        for part in set(of_branch.tolist()) - {0}:
            assert len(np.unique(pieces[of_branch == part])) == 1
