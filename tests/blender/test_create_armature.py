"""Armatures and curves from the parts of a mesh."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from examples import humanoid
from tests.blender.conftest import add_object
from tests.shapes import icosphere


@pytest.fixture(scope="module")
def human():
    return humanoid(4000)


@pytest.fixture
def body(scene, human):
    return scene(analyzed_human, human)


def analyzed_human(human):
    add_object(human.vertices, human.quads, "human")
    bpy.ops.eigenparts.analyze(order="1")


@pytest.fixture
def rigged(scene, human):
    """The body and its armature."""
    armature = scene(rigged_human, human)
    return bpy.data.objects["human"], armature


def rigged_human(human):
    analyzed_human(human)
    assert bpy.ops.eigenparts.create_armature(order="1") == {"FINISHED"}


def positions(obj):
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return np.array([vertex.co for vertex in evaluated.vertices])


def test_bones_form_one_tree_below_the_root(rigged):
    bones = rigged[1].data.bones
    assert [bone.name for bone in bones if bone.parent is None] == ["Root"]
    assert min(bone.length for bone in bones) > 0.005


def test_each_bone_but_the_root_has_a_group_and_weights_sum_to_one(rigged):
    obj, armature = rigged
    assert {bone.name for bone in armature.data.bones if bone.use_deform} == {group.name for group in obj.vertex_groups}
    sums = [sum(element.weight for element in vertex.groups) for vertex in obj.data.vertices]
    np.testing.assert_allclose(sums, 1, atol=1e-5)


def test_left_bones_mirror_right_ones(rigged):
    bones = rigged[1].data.bones
    left = [bone for bone in bones if bone.name.endswith(".L")]
    assert len(left) >= 8
    for bone in left:
        other = bones[bone.name[:-2] + ".R"]
        assert bone.tail_local.x > 0
        np.testing.assert_allclose(np.array(other.head_local) * [-1, 1, 1], bone.head_local, atol=0.01)


def test_an_armature_at_rest_moves_nothing(rigged, human):
    np.testing.assert_allclose(positions(rigged[0]), human.vertices, atol=1e-5)


def test_the_armature_poses_the_mesh_by_the_weights(rigged, human):
    obj, armature = rigged
    bone = next(bone for bone in armature.pose.bones if bone.name.endswith("_1.L") and bone.tail.z < 0.6)
    pivot = Matrix.Translation(bone.bone.head_local)
    motion = pivot @ Matrix.Rotation(1.0, 4, "X") @ pivot.inverted()
    bone.matrix_basis = bone.bone.matrix_local.inverted() @ motion @ bone.bone.matrix_local
    bpy.context.view_layer.update()
    moved = np.linalg.norm(positions(obj) - human.vertices, axis=1)
    leg = human.part_of_vertex == human.part_names.index("leg.L")
    assert moved[leg].sum() > 0.99 * moved.sum()
    assert moved[leg].max() > 0.5


def test_bones_are_called_after_the_parts(body):
    rows = body.data.eigenparts.rows
    arm = next(row for row in rows if row.n_faces and "Part" in row.title)
    arm.title = "Limb.L"
    bpy.ops.eigenparts.create_armature(order="1")
    assert any(bone.name.startswith("Limb") for bone in bpy.context.object.data.bones)


def test_the_armature_stands_where_a_moved_object_is(body, human):
    body.matrix_world = Matrix.Translation((3, 2, 1)) @ Matrix.Rotation(0.5, 4, "Z")
    bpy.context.view_layer.update()
    before = body.matrix_world.copy()
    bpy.ops.eigenparts.create_armature(order="1")
    bpy.context.view_layer.update()
    np.testing.assert_allclose(body.matrix_world, before, atol=1e-6)
    np.testing.assert_allclose(bpy.context.object.matrix_world, before, atol=1e-6)


def test_a_selected_pose_shows_where_limbs_bend(body, human):
    bpy.ops.eigenparts.create_armature(order="1", weights="NONE", bones_in_limbs=1)
    straight = len(bpy.context.object.data.bones)
    posed = add_object(human.mesh_in_pose("sit"), human.quads, "sitting")
    bpy.context.view_layer.objects.active = body
    bpy.ops.object.select_all(action="DESELECT")
    body.select_set(True)
    posed.select_set(True)
    bpy.ops.eigenparts.create_armature(order="1", weights="NONE", bones_in_limbs=1)
    assert len(bpy.context.object.data.bones) > straight


def test_groups_of_the_user_stay(body):
    group = body.vertex_groups.new(name="mine")
    group.add([0, 1], 0.5, "REPLACE")
    bpy.ops.eigenparts.create_armature(order="1")
    assert [element.weight for element in body.data.vertices[0].groups if element.group == group.index] == [0.5]


def test_blenders_own_weights_can_be_had(body):
    assert bpy.ops.eigenparts.create_armature(order="1", weights="AUTOMATIC") == {"FINISHED"}
    assert [modifier.type for modifier in body.modifiers] == ["ARMATURE"]
    assert sum(bool(vertex.groups) for vertex in body.data.vertices) > 0.99 * len(body.data.vertices)


def test_a_bound_mesh_is_refused(rigged):
    bpy.context.view_layer.objects.active = rigged[0]
    n_objects = len(bpy.data.objects)
    with pytest.raises(RuntimeError, match="armature already"):
        bpy.ops.eigenparts.create_armature(order="1")
    assert len(bpy.data.objects) == n_objects


@pytest.mark.parametrize("operator", ["create_armature", "create_skeleton_curves"])
def test_a_mesh_of_one_part_is_refused(operator):
    ball = icosphere(2)
    add_object(ball.vertices, ball.triangles, "ball")
    bpy.ops.eigenparts.analyze()
    with pytest.raises(RuntimeError, match="one part"):
        getattr(bpy.ops.eigenparts, operator)()
    assert len(bpy.data.armatures) == len(bpy.data.curves) == 0


def test_curves_follow_the_bones(body):
    assert bpy.ops.eigenparts.create_skeleton_curves(order="1") == {"FINISHED"}
    curve = bpy.context.object
    assert curve.type == "CURVE"
    assert len(curve.data.splines) == len(curve.data["eigenparts_spline_parts"])
    heads = np.array([point.co[:3] for spline in curve.data.splines for point in spline.points])
    assert heads[:, 2].min() < 0.1
    assert np.ptp(heads[:, 0]) > 1.4


@pytest.fixture
def registered(scene, human):
    """The body, and a walking one with other faces that is registered to it."""
    return scene(registered_humans, human), bpy.data.objects["walking"]


def registered_humans(human):
    analyzed_human(human)
    body, other = bpy.context.object, humanoid(5500)
    add_object(other.mesh_in_pose("walk"), other.quads, "walking")
    bpy.ops.object.select_all(action="SELECT")
    bpy.context.view_layer.objects.active = body
    bpy.ops.eigenparts.register_selected(order="1")


def create_armature_of(obj):
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.ops.eigenparts.create_armature(order="1")
    return bpy.context.object.data


def tree(armature):
    return {bone.name: bone.parent.name if bone.parent else None for bone in armature.bones}


def test_registered_characters_have_the_same_bones(registered):
    first, second = (tree(create_armature_of(obj)) for obj in registered)
    assert len(first) >= 20
    assert first == second


def test_bones_that_the_reference_does_not_have_yet_are_told(registered, capfd):
    create_armature_of(registered[1])
    assert "human has no armature of Eigenparts yet" in capfd.readouterr().out


def test_a_reference_that_was_deleted_is_not_asked_for_bones(registered, capfd):
    bpy.ops.object.select_all(action="DESELECT")
    registered[0].select_set(True)
    bpy.ops.object.delete()
    assert len(create_armature_of(registered[1]).bones) > 10
    assert "has no armature" not in capfd.readouterr().out


@pytest.mark.parametrize("text", ["", "[]", '{"parts": 1}', '{"parts": [0], "root": [], "limbs": [{"tips": [1e999]}]}'])
def test_a_damaged_layout_of_bones_is_passed_over(registered, text):
    registered[0].data["eigenparts_state"]["bone_layout"] = text
    assert len(create_armature_of(registered[1]).bones) > 5


def test_the_armature_is_one_step_of_undo(body):
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="analyzed")
        bpy.ops.eigenparts.create_armature(order="1")
        bpy.ops.ed.undo_push(message="bound")
        bpy.ops.ed.undo()
    obj = bpy.data.objects["human"]
    assert len(bpy.data.armatures) == 0
    assert len(obj.vertex_groups) == len(obj.modifiers) == 0
    assert obj.parent is None


def test_loose_parts_are_told_and_follow_what_is_near(human):
    ball = icosphere(1)
    vertices = np.concatenate([human.vertices, 0.02 * ball.vertices + [0, -0.3, 1.6]])
    faces = [*human.quads.tolist(), *(ball.triangles + len(human.vertices)).tolist()]
    obj = add_object(vertices, faces, "human")
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.create_armature(order="1")
    head = max(bpy.context.object.data.bones, key=lambda bone: bone.tail_local.z).name
    for vertex in list(obj.data.vertices)[len(human.vertices) :]:
        heaviest = max(vertex.groups, key=lambda element: element.weight)
        assert obj.vertex_groups[heaviest.group].name == head
