"""Weights, poses and true parts of the characters."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from examples import Bone, Pose
from examples.rig import bone_motions
from examples.skinning import blend_skinning


def edges(mesh):
    ends = np.stack([mesh.quads, np.roll(mesh.quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    return ends[ends[:, 0] < ends[:, 1]]


def lengths(vertices, ends):
    return np.linalg.norm(vertices[ends[:, 1]] - vertices[ends[:, 0]], axis=1)


def number_of_pieces(mesh, vertices):
    ends = edges(mesh)
    ends = ends[np.isin(ends, vertices).all(axis=1)]
    graph = coo_array((np.ones(len(ends)), ends.T), shape=2 * (len(mesh.vertices),))
    return len(np.unique(connected_components(graph, directed=False)[1][vertices]))


def test_a_bent_chain_carries_its_end():
    upper, lower = Bone("upper", None, (0, 0, 0), (1, 0, 0)), Bone("lower", "upper", (1, 0, 0), (2, 0, 0))
    motions = bone_motions((upper, lower), Pose({"upper": (0, 0, 90), "lower": (0, 0, 90)}, shift=(0, 0, 5)))
    np.testing.assert_allclose(motions[1] @ (2, 0, 0, 1), (-1, 1, 5, 1), atol=1e-12)


def test_angles_turn_about_z_first_and_x_last():
    motions = bone_motions((Bone("arm", None, (0, 0, 0), (1, 0, 0)),), Pose({"arm": (90, 0, 90)}))
    np.testing.assert_allclose(motions[0] @ (1, 0, 0, 1), (0, 0, 1, 1), atol=1e-12)


def test_weights_are_shares(character):
    assert (character.weights >= 0).all()
    np.testing.assert_allclose(character.weights.sum(axis=1), 1, atol=1e-12)


def test_the_tip_of_a_limb_follows_its_last_bones_alone(character):
    number = {bone.name: i for i, bone in enumerate(character.bones)}
    for bone in character.bones:
        if bone.parent and bone.name not in {other.parent for other in character.bones}:
            tip = np.linalg.norm(character.vertices - bone.tail, axis=1).argmin()
            assert character.weights[tip, [number[bone.name], number[bone.parent]]].sum() > 0.95


def test_the_rest_pose_is_the_mesh_itself(character):
    np.testing.assert_allclose(character.mesh_in_pose("rest"), character.vertices, atol=1e-12)


def test_turning_the_root_moves_the_character_rigidly(character):
    turn = bone_motions(character.bones, Pose({character.bones[0].name: (20, -30, 50)}, shift=(1, 2, 3)))
    turned = blend_skinning(character.vertices, character.weights, turn)
    expected = character.vertices @ turn[0, :3, :3].T + turn[0, :3, 3]
    np.testing.assert_allclose(turned, expected, atol=1e-12)


def test_poses_are_nearly_isometric(character):
    ends = edges(character)
    at_rest = lengths(character.vertices, ends)
    for pose in character.poses:
        ratio = lengths(character.mesh_in_pose(pose), ends) / at_rest
        assert abs(np.median(ratio) - 1) < 0.01
        low, high = np.percentile(ratio, [5, 95])
        assert low > 0.8, pose
        assert high < 1.25, pose


def test_poses_keep_the_volume_within_a_tenth(character):
    def volume(vertices):
        a, b, c = vertices[character.triangles].swapaxes(0, 1)
        return np.einsum("ij,ij->", a, np.cross(b, c)) / 6

    for pose in character.poses:
        assert abs(volume(character.mesh_in_pose(pose)) / volume(character.vertices) - 1) < 0.1, pose


@pytest.mark.parametrize("pose", ["rest", "arms_up", "sit"])
def test_a_symmetric_pose_gives_a_symmetric_mesh(coarse_humanoid, pose):
    vertices = coarse_humanoid.mesh_in_pose(pose)
    np.testing.assert_allclose(vertices[coarse_humanoid.mirror_of_vertex], vertices * (-1, 1, 1), atol=1e-9)


def test_every_part_is_one_piece(character):
    for names, parts in (
        (character.part_names, character.part_of_vertex),
        (character.fine_part_names, character.fine_part_of_vertex),
    ):
        assert [number_of_pieces(character, np.flatnonzero(parts == i)) for i in range(len(names))] == [1] * len(names)


def test_the_humanoid_has_the_parts_of_a_body(coarse_humanoid):
    assert set(coarse_humanoid.part_names) == {"head", "torso", "arm.L", "arm.R", "leg.L", "leg.R"}
    fingers = {f"{name}.{side}" for name in ("thumb", "index", "middle", "ring", "little") for side in "LR"}
    assert fingers <= set(coarse_humanoid.fine_part_names)


def test_no_two_fingers_are_grown_together_beyond_their_first_joint(coarse_humanoid):
    bones = np.array([bone.name for bone in coarse_humanoid.bones])[coarse_humanoid.weights.argmax(axis=1)]
    is_beyond = np.char.endswith(bones, "_2.L") | np.char.endswith(bones, "_3.L")
    first, second = edges(coarse_humanoid).T
    touching = is_beyond[first] & is_beyond[second]
    fingers = np.array([bone.split("_")[0] for bone in bones])
    np.testing.assert_array_equal(fingers[first[touching]], fingers[second[touching]])
    assert len(np.unique(fingers[first[touching]])) == 5


def test_the_left_side_of_the_part_names_is_at_positive_x(symmetric_character):
    for number, name in enumerate(symmetric_character.part_names):
        x = symmetric_character.vertices[symmetric_character.part_of_vertex == number, 0].mean()
        assert {".L": x > 0, ".R": x < 0}.get(name[-2:], abs(x) < 1e-3)


def test_a_face_belongs_to_the_part_of_most_of_its_corners(character):
    corners = character.fine_part_of_vertex[character.quads]
    agreeing = (corners == character.fine_part_of_quad[:, None]).sum(axis=1)
    assert (agreeing >= 1).all()
    assert np.mean(agreeing >= 2) > 0.99
