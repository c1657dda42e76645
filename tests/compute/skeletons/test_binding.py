"""Weights: shares, and what a turned bone moves."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from compute import binding_weights, mirror_parts, skeleton
from compute.skeletons.binding import MOST_BONES
from compute.skeletons.symmetry import sides

# How far beyond a joint a turned bone may move anything, by the size of the character.
BAND = 0.05


def subtree(found, joint):
    """Return the bones that hang on a bone, itself among them."""
    hanging = {joint}
    for other in range(joint + 1, len(found.parent)):
        if found.parent[other] in hanging:
            hanging.add(other)
    return sorted(hanging)


@pytest.fixture
def bound(rigged):
    character, analysis = rigged
    found = skeleton(analysis, mode="nested", n_pieces=2)
    return character, found, binding_weights(analysis, found)


def test_weights_are_shares_of_few_bones(bound):
    _, _, weights = bound
    assert (weights >= 0).all()
    np.testing.assert_allclose(weights.sum(axis=1), 1, atol=1e-12)
    assert (weights > 0).sum(axis=1).max() <= MOST_BONES


def test_a_turned_bone_moves_what_hangs_on_it_and_little_else(bound):
    character, found, weights = bound
    vertices = character.vertices
    for joint in range(1, len(found.joints)):
        hanging = subtree(found, joint)
        inside = np.isin(found.bone_of_vertex, hanging)
        pivot = found.joints[found.parent[joint]]
        turned = Rotation.from_euler("xyz", [30, 40, 20], degrees=True).apply(vertices - pivot) + pivot
        moved = weights[:, hanging].sum(axis=1) * np.linalg.norm(turned - vertices, axis=1)
        near = cKDTree(vertices[inside]).query(vertices)[0] < BAND * np.ptp(vertices, axis=0).max()
        assert moved[near].sum() >= 0.99 * moved.sum()


def test_the_tip_of_a_limb_follows_its_last_bone_alone(bound):
    character, found, weights = bound
    for leaf in np.setdiff1d(np.arange(1, len(found.joints)), found.parent):
        tip = np.linalg.norm(character.vertices - found.joints[leaf], axis=1).argmin()
        assert weights[tip, leaf] > 0.95


def test_a_reflected_character_has_a_left_and_a_right_side(human, human_analysis):
    labels = human_analysis.segment(mode="features").labels
    partner = mirror_parts(human_analysis, labels)
    side = sides(skeleton(human_analysis, partner=partner), partner)
    x = np.array([human.vertices[human.triangles[labels == part], 0].mean() for part in range(len(side))])
    np.testing.assert_array_equal(side, np.sign(np.round(x, 1)))
    assert np.count_nonzero(side) == 4


def test_matching_finds_the_sides_of_a_pose_that_is_not_symmetric(human):
    from compute import TriangleMesh, analyze

    analysis = analyze(TriangleMesh(human.mesh_in_pose("walk"), human.triangles), order=1)
    labels = analysis.segment(mode="features").labels
    partner = mirror_parts(analysis, labels)
    x = [human.vertices[human.triangles[labels == part], 0].mean() for part in range(1, labels.max() + 1)]
    for part, place in enumerate(x, start=1):
        assert partner[part] != part or abs(place) < 0.05
        np.testing.assert_allclose(x[partner[part] - 1], -place, atol=0.05)


def test_mirrored_limbs_have_joints_at_mirrored_places(human_analysis):
    partner = mirror_parts(human_analysis, human_analysis.segment(mode="features").labels)
    found = skeleton(human_analysis, n_pieces=2, partner=partner)
    for part, other in enumerate(partner):
        if part < other:
            here, there = found.joints[found.part == part], found.joints[found.part == other]
            np.testing.assert_allclose(here * [-1, 1, 1], there, atol=0.01)
