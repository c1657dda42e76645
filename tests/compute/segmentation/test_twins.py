"""Twins: what a symmetry maps onto each other appears and is cut off together, in every pose."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from compute import READINGS, TriangleMesh, analyze
from examples import humanoid
from tests.shapes import star


def triangles_of(quads):
    return np.vstack([quads[:, :3], quads[:, [0, 2, 3]]])


@pytest.fixture(scope="module")
def character():
    return humanoid(6000)


def analysis_in(character, pose):
    return analyze(TriangleMesh(character.mesh_in_pose(pose), triangles_of(character.quads)), order=1)


@pytest.fixture(scope="module", params=["rest", "walk"])
def analysis(character, request):
    return analysis_in(character, request.param)


@pytest.mark.parametrize("mode", READINGS)
def test_every_level_of_a_symmetric_body_is_symmetric_in_every_pose(character, analysis, mode):
    """Each part covers its own mirror image in the rest pose, or that of one other part."""
    rest = character.mesh_in_pose("rest")[triangles_of(character.quads)].mean(axis=1)
    mirror = cKDTree(rest).query(rest * [-1, 1, 1])[1]
    area = analysis.mesh.areas
    for level in range(analysis.hierarchy.n_levels):
        labels = analysis.exact_labels(analysis.segment(level=level, mode=mode).labels)
        for part in np.unique(labels):
            image = labels[mirror] == part
            overlaps = [
                area[image & (labels == other)].sum() / area[image | (labels == other)].sum()
                for other in np.unique(labels[image])
            ]
            assert max(overlaps) > 0.6, (level, part)


def test_twins_are_pairs_and_equally_high(analysis):
    (tree,) = analysis.hierarchy.trees
    joined = np.flatnonzero(tree.joint_part != tree.part)
    assert len(joined)
    for arc in joined.tolist():
        twin = np.flatnonzero(tree.part == tree.joint_part[arc])[0]
        assert tree.joint_part[twin] == tree.part[twin]
        heights = analysis.field.values[tree.extremum[[arc, twin]]]
        assert np.ptp(heights) < 0.05 * analysis.field.value_range


@pytest.mark.parametrize("reading", READINGS)
def test_a_part_covers_the_mirror_image_of_its_twin(character, analysis, reading):
    """In the rest pose, whatever pose was analyzed; and twins are each other's."""
    rest = character.mesh_in_pose("rest")[triangles_of(character.quads)].mean(axis=1)
    image = cKDTree(rest).query(rest * [-1, 1, 1])[1]
    area = analysis.mesh.areas
    for level in range(analysis.hierarchy.n_levels):
        segmentation = analysis.segment(level=level, mode=reading)
        mirror = dict(zip(segmentation.parts.id.tolist(), segmentation.parts.mirror.tolist(), strict=True))
        labels = analysis.exact_labels(segmentation.labels)
        for part, twin in mirror.items():
            if twin >= 0:
                assert mirror[twin] == part != twin
                here, there = labels == part, labels[image] == twin
                assert area[here & there].sum() > 0.6 * area[here | there].sum()
        if segmentation.level == analysis.hierarchy.default_level:
            assert sum(twin >= 0 for twin in mirror.values()) >= 4


def test_a_part_without_a_twin_says_so():
    assert set(analyze(star(5, 3)).segment().parts.mirror.tolist()) == {-1}


def test_a_shape_without_symmetry_has_no_twins():
    (tree,) = analyze(star(5, 3)).hierarchy.trees
    np.testing.assert_array_equal(tree.joint_part, tree.part)
    np.testing.assert_array_equal(tree.joint_closing, tree.closing)
