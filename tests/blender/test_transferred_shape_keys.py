"""Transfer: shape keys keep what they are set to, and their drivers follow what is the target's own."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, values_of
from tests.compute.registration.shapes import lumpy_ball


def add_ball(name):
    """Add a ball with a Basis, deformed by an armature of its own."""
    ball = lumpy_ball(2)
    obj = add_object(ball.vertices, ball.triangles, name)
    obj.shape_key_add(name="Basis")
    rig = bpy.data.objects.new(f"rig of {name}", bpy.data.armatures.new(f"rig of {name}"))
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones.new("Jaw.L").tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    obj.modifiers.new("Armature", "ARMATURE").object = rig
    bpy.context.view_layer.objects.active = obj
    return obj


@pytest.fixture
def target():
    return add_ball("target")


@pytest.fixture
def source(target):
    """The source, active, with a key Smile.L that is set to everything unusual."""
    obj = add_ball("source")
    group = obj.vertex_groups.new(name="Mouth.L")
    group.add(list(range(40)), 0.5, "REPLACE")
    for name in ("Open", "Smile.L"):
        obj.shape_key_add(name=name)
    keys = obj.data.shape_keys.key_blocks
    smile = keys["Smile.L"]
    smile.slider_min, smile.slider_max, smile.value, smile.mute = -2, -1, -1.5, True
    smile.interpolation, smile.vertex_group, smile.relative_key = "KEY_BSPLINE", "Mouth.L", keys["Open"]
    target.select_set(True)
    obj.select_set(True)
    return obj


def transferred(target, name="Smile.L", **options):
    bpy.ops.eigenparts.transfer(layers={"SHAPE_KEYS"}, **options)
    return target.data.shape_keys.key_blocks[name]


def add_driver(source, kind="TRANSFORMS", setting="value"):
    """Let the key follow the armature; returns driver and variable."""
    driver = source.data.shape_keys.key_blocks["Smile.L"].driver_add(setting).driver
    variable = driver.variables.new()
    driver.type, driver.expression, variable.name, variable.type = "SCRIPTED", "-turn * 2", "turn", kind
    return driver, variable


def driver_of(target, path='key_blocks["Smile.L"].value'):
    return target.data.shape_keys.animation_data.drivers.find(path)


def test_range_value_mute_and_interpolation_come_along(source, target):
    smile = transferred(target)
    assert (smile.slider_min, smile.slider_max, smile.value, smile.mute) == (-2, -1, -1.5, True)
    assert smile.interpolation == "KEY_BSPLINE"


def test_a_key_starts_from_the_same_key_whatever_their_order(source, target):
    source.active_shape_key_index = 2
    bpy.ops.object.shape_key_move(type="TOP")
    bpy.context.view_layer.objects.active = source
    assert transferred(target).relative_key.name == "Open"


def test_the_vertex_group_of_a_key_comes_along_where_there_is_none(source, target):
    assert transferred(target).vertex_group == "Mouth.L"
    index = target.vertex_groups["Mouth.L"].index
    weights = [sum(g.weight for g in vertex.groups if g.group == index) for vertex in target.data.vertices]
    np.testing.assert_allclose(weights, np.where(np.arange(len(weights)) < 40, 0.5, 0), atol=1e-6)


def test_a_vertex_group_of_the_target_stays_as_it_is(source, target):
    target.vertex_groups.new(name="Mouth.L").lock_weight = True
    assert transferred(target).vertex_group == "Mouth.L"
    assert not any(len(vertex.groups) for vertex in target.data.vertices)


def test_a_key_that_was_there_keeps_its_own_settings(source, target):
    target.shape_key_add(name="Smile.L").slider_max = 3
    assert transferred(target).slider_max == 3


def test_a_driver_follows_the_armature_of_the_target(source, target):
    _, variable = add_driver(source)
    read = variable.targets[0]
    read.id, read.bone_target, read.transform_type = bpy.data.objects["rig of source"], "Jaw.L", "ROT_X"
    transferred(target)
    driver = driver_of(target).driver
    read = driver.variables["turn"].targets[0]
    assert (driver.type, driver.expression) == ("SCRIPTED", "-turn * 2")
    assert (read.id.name, read.bone_target, read.transform_type) == ("rig of target", "Jaw.L", "ROT_X")


@pytest.mark.parametrize(
    ("path", "own"),
    [
        ('key_blocks["Open"].value', lambda obj: obj.data.shape_keys),
        ("location.x", lambda obj: obj),
        ("auto_texspace", lambda obj: obj.data),
        ('pose.bones["Jaw.L"].rotation_quaternion[1]', lambda obj: obj.modifiers[0].object),
        ("show_names", lambda obj: obj.modifiers[0].object.data),
    ],
)
def test_a_driver_follows_what_is_the_target_s_own(source, target, path, own):
    _, variable = add_driver(source, "SINGLE_PROP", "mute")
    read = variable.targets[0]
    read.id_type, read.id, read.data_path = own(source).id_type, own(source), path
    transferred(target)
    read = driver_of(target, 'key_blocks["Smile.L"].mute').driver.variables["turn"].targets[0]
    assert (read.id, read.data_path) == (own(target), path)


def test_what_no_driver_can_follow_on_the_target_stays_and_is_told(source, target, capfd):
    _, variable = add_driver(source)
    variable.targets[0].id, variable.targets[0].bone_target = bpy.data.objects["rig of source"], "Jaw.L"
    bpy.data.objects["rig of target"].data.bones["Jaw.L"].name = "Chin"
    transferred(target)
    assert driver_of(target).driver.variables["turn"].targets[0].id.name == "rig of source"
    assert 'Warning: target: nothing here takes the place of "rig of source"' in capfd.readouterr().out


def test_the_curve_of_a_driver_comes_along(source, target):
    add_driver(source)
    curve = driver_of(source)
    curve.keyframe_points.clear()
    curve.keyframe_points.insert(0, 1)
    curve.keyframe_points.insert(2, 5).interpolation = "CONSTANT"
    curve.modifiers.new("LIMITS").max_y = 4
    curve.extrapolation = "LINEAR"
    transferred(target)
    assert [driver_of(target).evaluate(x) for x in (0, 1, 3)] == [curve.evaluate(x) for x in (0, 1, 3)]
    assert driver_of(target).extrapolation == "LINEAR"


def test_a_mirrored_driver_follows_the_bone_of_the_other_side(source, target):
    _, variable = add_driver(source)
    variable.targets[0].id, variable.targets[0].bone_target = bpy.data.objects["rig of source"], "Jaw.L"
    bpy.data.objects["rig of target"].data.bones["Jaw.L"].name = "Jaw.R"
    positions = values_of(target.data, "position", 3, np.float32, "vector") * np.float32([-1, 1, 1])
    target.data.attributes["position"].data.foreach_set("vector", positions.ravel())
    target.data.shape_keys.key_blocks[0].data.foreach_set("co", positions.ravel())
    target.data.flip_normals()
    assert transferred(target, "Smile.R", mirrored=True).vertex_group == "Mouth.R"
    read = driver_of(target, 'key_blocks["Smile.R"].value').driver.variables["turn"].targets[0]
    assert (read.id.name, read.bone_target) == ("rig of target", "Jaw.R")
