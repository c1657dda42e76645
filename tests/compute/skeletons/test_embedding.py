"""Skeletons of shapes whose joints are known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from compute import LevelError, MeshError, TriangleMesh, analyze, skeleton
from compute.skeletons.interior import Interior
from tests.compute.skeletons.conftest import leaves, winding_numbers
from tests.shapes import icosphere, joined, star, torus

# The rig's joints that an artist cannot do without, and how near to each a joint must be found, by the height.
LIMB_JOINTS = ("upper_arm", "hand", "thigh", "foot")
NEAR = 0.05


def lengths(found):
    return np.linalg.norm(found.joints[1:] - found.joints[found.parent[1:]], axis=1)


def distances(first, second):
    return np.linalg.norm(first[:, None] - second, axis=2).min(axis=1)


def joints_of(character):
    return np.unique([point for bone in character.bones for point in (bone.head, bone.tail)], axis=0)


def size_of(character):
    return np.ptp(character.vertices, axis=0).max()


def test_a_rod_has_bones_along_its_axis():
    ball = icosphere(3)
    found = skeleton(analyze(TriangleMesh(ball.vertices * [1, 1, 6], ball.triangles)))
    assert len(leaves(found)) == 2
    assert np.abs(found.joints[:, :2]).max() < 0.05
    assert np.abs(found.joints[leaves(found), 2]).min() > 5


@pytest.mark.parametrize("n_arms", [3, 5])
def test_a_star_has_a_limb_in_each_arm(n_arms):
    found = skeleton(analyze(star(n_arms), order=1))
    tips = found.joints[leaves(found)]
    angles = np.sort((np.arctan2(tips[:, 1], tips[:, 0]) + 0.5) % (2 * np.pi)) - 0.5
    np.testing.assert_allclose(angles, 2 * np.pi * np.arange(n_arms) / n_arms, atol=0.05)
    assert np.linalg.norm(found.joints[0]) < 0.3


def test_the_handle_of_a_torus_is_a_loop_that_is_opened():
    ring = torus(48, 24)
    found = skeleton(analyze(ring, field=ring.vertices[:, 0] + 0.01 * ring.vertices[:, 1]))
    (end, start) = found.loops[0]
    assert len(found.loops) == 1
    assert "handle" in found.warnings[0]
    np.testing.assert_allclose(found.joints[end], found.joints[start], atol=0.2)
    inner = np.linalg.norm(found.joints[:, :2], axis=1)[2:]
    assert np.abs(inner - 3).max() < 1


def test_every_joint_lies_inside(rigged):
    character, analysis = rigged
    found = skeleton(analysis, n_pieces=2)
    mesh = TriangleMesh(character.vertices, character.triangles)
    assert winding_numbers(found.joints, mesh).min() > 0.5


def test_joints_form_a_tree_of_real_bones(rigged):
    found = skeleton(rigged[1], n_pieces=3)
    assert found.parent[0] == -1
    assert (found.parent[1:] < np.arange(1, len(found.parent))).all()
    assert (found.parent[1:] >= 0).all()
    assert lengths(found).min() > 0.005 * size_of(rigged[0])


def test_joints_are_near_those_of_the_rig_and_the_other_way_round(rigged):
    character, analysis = rigged
    true, found = joints_of(character), skeleton(analysis, n_pieces=2).joints
    assert distances(true, found).mean() < NEAR * size_of(character)
    assert distances(found, true).mean() < NEAR * size_of(character)


@pytest.mark.parametrize("bone", LIMB_JOINTS)
def test_shoulders_hips_wrists_and_ankles_are_found(human, human_analysis, bone):
    heads = {known.name: known.head for known in human.bones}
    true = np.array([heads[f"{bone}.L"], heads[f"{bone}.R"]])
    found = skeleton(human_analysis, mode="nested").joints
    assert distances(true, found).max() < NEAR * np.ptp(human.vertices[:, 2])


def test_the_octopus_has_eight_arms_and_a_mantle(kraken_analysis):
    found = skeleton(kraken_analysis)
    assert len(leaves(found)) == 9
    assert len(np.unique(found.part[leaves(found)])) == 9


def test_each_limb_is_a_part_and_each_part_has_bones(rigged):
    segmentation = rigged[1].segment(joints=False)
    found = skeleton(rigged[1], mode="nested")
    limbs = segmentation.parts.id[segmentation.parts.id > 0]
    assert set(limbs) <= set(found.part)


def test_another_pose_shows_the_elbow(human, human_analysis):
    elbow = np.array([bone.head for bone in human.bones if bone.name == "forearm.L"])
    straight = skeleton(human_analysis)
    bent = skeleton(human_analysis, poses=[human.mesh_in_pose("sit")])
    assert distances(elbow, straight.joints)[0] > 0.05
    assert distances(elbow, bent.joints)[0] < 0.03


def test_a_straight_limb_is_halved_on_request(human, human_analysis):
    elbow = np.array([bone.head for bone in human.bones if bone.name == "forearm.L"])
    assert distances(elbow, skeleton(human_analysis, n_pieces=2).joints)[0] < 0.03


def test_the_skeleton_turns_and_grows_with_the_shape():
    shape = star(5)
    turn = Rotation.from_euler("xyz", [0.3, 0.5, -0.8]).as_matrix()
    moved = TriangleMesh(7 * shape.vertices @ turn.T + [1, 2, 3], shape.triangles)
    first, second = skeleton(analyze(shape, order=1)), skeleton(analyze(moved, order=1))
    np.testing.assert_array_equal(first.parent, second.parent)
    np.testing.assert_allclose(7 * first.joints @ turn.T + [1, 2, 3], second.joints, atol=0.1)


def test_a_level_with_more_features_has_more_limbs(human_analysis):
    default = human_analysis.hierarchy.default_level
    fewer = skeleton(human_analysis, level=default)
    assert len(leaves(skeleton(human_analysis, level=default + 8))) > len(leaves(fewer))


def test_rays_tell_the_inside_as_the_winding_number_does(human, human_analysis):
    low, high = human.vertices.min(axis=0), human.vertices.max(axis=0)
    points = np.random.default_rng(0).uniform(low, high, size=(200, 3))
    mesh = TriangleMesh(human.vertices, human.triangles)
    np.testing.assert_array_equal(
        Interior.of(human_analysis.surface).holds(points), winding_numbers(points, mesh) > 0.5
    )


def test_of_several_components_the_largest_has_the_bones():
    shape, ball = star(4), icosphere(1)
    found = skeleton(analyze(joined(shape, TriangleMesh(0.2 * ball.vertices + [0, 0, 5], ball.triangles)), order=1))
    assert np.abs(found.joints[:, 2]).max() < 1
    assert "loose parts" in found.warnings[0]


def test_a_sphere_has_no_bones():
    with pytest.raises(LevelError, match="one part"):
        skeleton(analyze(icosphere(2)))


def test_a_level_with_one_part_has_no_bones(human_analysis):
    with pytest.raises(LevelError, match="one part"):
        skeleton(human_analysis, level=0)


def test_a_pose_of_another_mesh_is_refused(human_analysis):
    with pytest.raises(MeshError, match="Pose 1"):
        skeleton(human_analysis, poses=[np.zeros((4, 3))])


@pytest.mark.parametrize("level", [1, 2, -1])
def test_coarse_shapes_have_sound_bones_at_every_level(level):
    shape = star(4, n_subdivisions=2)
    analysis = analyze(shape)
    found = skeleton(analysis, level=level % analysis.hierarchy.n_levels, n_pieces=2)
    assert np.isfinite(found.joints).all()
    assert lengths(found).min() > 0
    assert found.bone_of_vertex.min() >= 1
