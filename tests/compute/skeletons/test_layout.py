"""The bones of one shape laid into another that is divided into the same parts."""

import numpy as np
import pytest

from compute import TriangleMesh, analyze, skeleton
from compute.registration.parts.population import register
from compute.skeletons.layout import level_with_tips
from examples import humanoid
from tests.shapes import star


@pytest.fixture(scope="module")
def walking(human_analysis):
    """A walking character with other faces, its analysis and the parts of the standing one on it."""
    other = humanoid(5000)
    analysis = analyze(TriangleMesh(other.mesh_in_pose("walk"), other.triangles), order=2)
    return other, analysis, register([human_analysis, analysis])[1].labels


def bones(found):
    """Return the part of each bone and of the one before it, as far as order does not matter."""
    return sorted(zip(found.part[1:].tolist(), found.part[found.parent[1:]].tolist(), strict=True))


def test_registered_characters_have_the_same_bones(human_analysis, walking):
    reference = skeleton(human_analysis, n_pieces=2)
    found = skeleton(walking[1], labels=walking[2], layout=reference.layout)
    assert bones(found) == bones(reference)
    assert set(found.layout.limbs) == set(reference.layout.limbs)


def test_a_skeleton_laid_out_like_itself_stays_as_it_is(human_analysis):
    found = skeleton(human_analysis, n_pieces=2)
    again = skeleton(human_analysis, labels=human_analysis.segment(mode="features").labels, layout=found.layout)
    np.testing.assert_array_equal(found.parent, again.parent)
    np.testing.assert_allclose(found.joints, again.joints, atol=1e-12)


@pytest.mark.parametrize("level", [2, 3])
def test_parts_from_deeper_levels_have_bones_too(human_analysis, level):
    reference = skeleton(human_analysis, n_pieces=2)
    labels = human_analysis.segment(mode="features").labels
    found = skeleton(human_analysis, level=level, labels=labels, layout=reference.layout)
    assert (
        level_with_tips(human_analysis, labels, reference.layout.tips, level) == human_analysis.hierarchy.default_level
    )
    np.testing.assert_allclose(found.joints, reference.joints, atol=1e-12)


def test_parts_that_the_other_shape_does_not_have_get_bones_of_their_own():
    few, many = star(4), analyze(star(5), order=1)
    reference = skeleton(analyze(few, order=1))
    labels = many.segment(mode="features").labels
    found = skeleton(many, labels=labels, layout=reference.layout)
    assert set(found.part) >= set(np.unique(labels)) - {0}


def test_a_part_that_is_missing_leaves_the_others_their_bones():
    many, few = analyze(star(5), order=1), analyze(star(4), order=1)
    found = skeleton(few, labels=few.segment(mode="features").labels, layout=skeleton(many).layout)
    assert set(np.unique(found.part)) - {0} == set(np.unique(few.segment(mode="features").labels)) - {0}
