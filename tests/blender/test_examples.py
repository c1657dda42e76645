import bpy
import numpy as np
import pytest

import examples
from examples.blender import add_character, add_posed_mesh, apply_pose


def positions(obj):
    data = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    values = np.empty(3 * len(data.vertices), dtype=np.float32)
    data.attributes["position"].data.foreach_get("vector", values)
    return values.reshape(-1, 3)


@pytest.fixture(scope="module", params=["humanoid", "octopus", "quadruped", "hand", "handles"])
def character(request):
    return getattr(examples, request.param)()


def test_the_armature_poses_as_the_skinning_does(character):
    mesh, armature = add_character(character)
    for pose in character.poses:
        apply_pose(armature, character, pose)
        np.testing.assert_allclose(positions(mesh), character.mesh_in_pose(pose), atol=1e-5)


def test_the_mesh_is_made_of_quads_with_a_group_for_each_bone(character):
    mesh, armature = add_character(character, list(character.poses)[-1])
    assert {len(polygon.vertices) for polygon in mesh.data.polygons} == {4}
    names = [bone.name for bone in character.bones]
    assert [group.name for group in mesh.vertex_groups] == names
    assert sorted(bone.name for bone in armature.data.bones) == sorted(names)
    assert not mesh.data.validate()


def test_triangles_are_those_of_blender(character):
    obj = add_posed_mesh(character)
    triangles = np.empty(3 * len(obj.data.loop_triangles), dtype=np.int32)
    obj.data.loop_triangles.foreach_get("vertices", triangles)
    same = np.sort(triangles.reshape(-1, 3), axis=1) == np.sort(character.triangles, axis=1)
    assert np.mean(same.all(axis=1)) > 0.999
    np.testing.assert_allclose(positions(obj), character.vertices, atol=1e-6)
