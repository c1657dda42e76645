"""Bones and curves of shapes with handles, and of shapes so small or far away that bones have hardly any length."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object
from tests.shapes import star


def rows(parent, part, loops):
    from eigenparts.operators.armature.create_skeleton_curves import rows_of_bones

    return rows_of_bones(np.array(parent), np.array(part), np.array(loops).reshape(-1, 2))


def test_a_loop_that_ends_at_the_root_is_closed_there():
    assert rows([-1, 0, 1], [0, 1, 1], [[0, 2]]) == [[0, 1, 2], [0, 2]]


def test_a_loop_that_ends_at_a_joint_with_children_is_closed_there():
    assert rows([-1, 0, 1, 1], [0, 1, 1, 1], [[1, 3]]) == [[1, 2], [1, 3], [0, 1, 3]]


def test_a_row_that_goes_on_beyond_the_end_of_a_loop_stays_whole():
    assert rows([-1, 0, 1], [0, 1, 1], [[1, 0]]) == [[0, 1, 2], [1, 0]]


def test_a_loop_without_length_is_none():
    assert rows([-1, 0], [0, 1], [[1, 1]]) == [[0, 1]]


def bone_ends(joints, parent, radius=0.1):
    from eigenparts.operators.armature.create_armature import bone_ends

    joints = np.array(joints, dtype=float)
    return bone_ends(SimpleNamespace(joints=joints, parent=np.array(parent), radius=np.full(len(joints), radius)))


def test_no_bone_is_so_short_that_blender_deletes_it():
    heads, tails = bone_ends([[0, 0, 0], [0, 0, 0], [0, 0, 1e-9], [1, 0, 0]], [-1, 0, 1, 2], radius=0)
    lengths = np.linalg.norm(tails - heads, axis=1)
    assert lengths[:3].min() >= 9e-5
    np.testing.assert_allclose(lengths[3], 1)


def test_far_from_the_origin_bones_keep_their_ends_apart():
    heads, tails = (np.float32(ends) for ends in bone_ends(1e6 + np.zeros((3, 3)), [-1, 0, 1]))
    assert (np.abs(tails - heads).max(axis=1) > 0).all()


@pytest.mark.parametrize(("size", "place"), [(1e-6, 0), (1e-5, 0), (1, 1e5)])
def test_every_bone_survives_in_small_units_and_far_away(size, place):
    mesh = star(n_arms=5, n_subdivisions=2)
    obj = add_object(size * mesh.vertices + place, mesh.triangles)
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.create_armature(order="1")
    bones = bpy.context.object.data.bones
    assert len(bones) > 5
    assert {bone.name for bone in bones if bone.use_deform} == {group.name for group in obj.vertex_groups}
    assert [bone.name for bone in bones if bone.parent is None] == ["Root"]
