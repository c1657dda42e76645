"""Segment and the level in the panel: any level at once, from what the analysis left."""

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, analyze
from examples import humanoid
from tests.blender.conftest import add_object, everything_on, values_of


@pytest.fixture(scope="module")
def engine(star):
    return analyze(TriangleMesh(np.float32(star.vertices), star.triangles))


@pytest.mark.parametrize("mode", ["features", "nested"])
@pytest.mark.parametrize("choice", [{"level": 0}, {"level": 2}, {"threshold": 0.3}, {"n_parts": 4}, {}])
def test_parts_are_those_of_the_engine(analyzed, engine, choice, mode):
    bpy.ops.eigenparts.segment(**choice, mode=mode.upper())
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), engine.segment(**choice, mode=mode).labels)


def test_the_mode_stays_until_another_is_chosen(analyzed, engine):
    assert analyzed.data.eigenparts.mode == "NESTED"
    analyzed.data.eigenparts.mode = "FEATURES"
    analyzed.data.eigenparts.level = 2
    bpy.ops.eigenparts.segment(level=3)
    assert analyzed.data.eigenparts.mode == "FEATURES"
    bpy.ops.eigenparts.analyze()
    assert analyzed.data.eigenparts.mode == "FEATURES"
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), engine.segment(mode="features").labels)


def triangles_of(mesh):
    mesh.calc_loop_triangles()
    vertices = np.array([vertex.co for vertex in mesh.vertices])
    return TriangleMesh(vertices, np.array([triangle.vertices for triangle in mesh.loop_triangles]))


@pytest.fixture
def humanoid_mesh(scene):
    """An analyzed body with limbs that have joints."""
    return scene(analyzed_humanoid).data


def analyzed_humanoid():
    character = humanoid(6000)
    add_object(character.mesh_in_pose("rest"), character.quads.tolist(), "humanoid")
    bpy.ops.eigenparts.analyze()


def test_joints_stay_while_the_level_moves(humanoid_mesh):
    settings = humanoid_mesh.eigenparts
    analysis = analyze(triangles_of(humanoid_mesh))
    assert settings.joints
    for level in range(analysis.hierarchy.n_levels):
        settings.level = level
        assert settings.joints
        assert settings.mode == "NESTED"
        assert settings.n_parts == analysis.segment(level=level, joints=True).n_parts
    bpy.ops.eigenparts.segment()
    assert settings.n_parts == analysis.segment().n_parts > analysis.segment(joints=False).n_parts
    settings.joints = False
    assert settings.n_parts == analysis.segment(joints=False).n_parts


def test_joints_can_be_asked_for_by_scripts(humanoid_mesh):
    with_joints = humanoid_mesh.eigenparts.n_parts
    bpy.ops.eigenparts.segment(joints=False)
    n_parts = humanoid_mesh.eigenparts.n_parts
    assert with_joints > n_parts
    bpy.ops.eigenparts.segment(mode="NESTED")
    assert humanoid_mesh.eigenparts.n_parts == n_parts
    bpy.ops.eigenparts.segment(joints=True)
    assert humanoid_mesh.eigenparts.n_parts == with_joints
    bpy.ops.eigenparts.segment(mode="FEATURES")
    bpy.ops.eigenparts.segment(mode="NESTED")
    assert humanoid_mesh.eigenparts.n_parts == with_joints


def test_features_have_no_joints(humanoid_mesh):
    bpy.ops.eigenparts.segment(joints=True)
    bpy.ops.eigenparts.segment(mode="FEATURES")
    assert not humanoid_mesh.eigenparts.joints
    before = everything_on(humanoid_mesh)
    with pytest.raises(RuntimeError, match="nested parts only"):
        bpy.ops.eigenparts.segment(joints=True)
    assert everything_on(humanoid_mesh) == before


def test_corrections_and_names_stay_on_what_a_joint_cuts_off(humanoid_mesh):
    settings = humanoid_mesh.eigenparts
    bpy.ops.eigenparts.segment(joints=True)
    hand = max(row.part for row in settings.rows)
    next(row for row in settings.rows if row.part == hand).title = "Hand"
    bpy.ops.eigenparts.split_part(part=hand, position=0.5)
    labels = values_of(humanoid_mesh, "part")
    settings.level -= 1
    settings.level += 1
    np.testing.assert_array_equal(values_of(humanoid_mesh, "part"), labels)
    assert next(row for row in settings.rows if row.part == hand).title == "Hand"
    bpy.ops.eigenparts.analyze()
    np.testing.assert_array_equal(values_of(humanoid_mesh, "part"), labels)
    assert next(row for row in settings.rows if row.part == hand).title == "Hand"


def test_every_level_can_be_reached_from_the_panel(analyzed, engine):
    for level in range(engine.hierarchy.n_levels):
        analyzed.data.eigenparts.level = level
        assert analyzed.data.eigenparts.level == level
        np.testing.assert_array_equal(values_of(analyzed.data, "part"), engine.segment(level=level).labels)


def test_the_number_of_parts_and_the_level_tell_the_same(analyzed, engine):
    analyzed.data.eigenparts.n_parts = 3
    assert analyzed.data.eigenparts.n_parts == 3 == len(set(values_of(analyzed.data, "part")))
    assert analyzed.data.eigenparts.level == engine.segment(n_parts=3).level


def test_the_panel_stops_at_the_highest_level(analyzed, engine):
    analyzed.data.eigenparts.level = 1000
    assert analyzed.data.eigenparts.level == engine.hierarchy.n_levels - 1


@pytest.mark.parametrize(
    ("choice", "sentence"),
    [
        ({"level": 1000}, "Level 1000 does not exist"),
        ({"level": -1}, "Level -1 does not exist"),
        ({"threshold": -0.5}, "threshold is a fraction"),
        ({"n_parts": 0}, "at least 1"),
        ({"level": 1, "n_parts": 2}, "not several"),
    ],
)
def test_what_does_not_exist_is_refused_and_nothing_changes(analyzed, choice, sentence):
    before = everything_on(analyzed.data)
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.eigenparts.segment(**choice)
    assert everything_on(analyzed.data) == before


def test_a_part_can_be_selected_for_editing(analyzed):
    labels = values_of(analyzed.data, "part")
    bpy.ops.eigenparts.select_part(part=3)
    assert analyzed.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    selected = [polygon.select for polygon in analyzed.data.polygons]
    np.testing.assert_array_equal(selected, labels == 3)


def test_a_part_that_is_not_there_is_not_selected(analyzed):
    with pytest.raises(RuntimeError, match="no part 99"):
        bpy.ops.eigenparts.select_part(part=99)
    assert analyzed.mode == "OBJECT"


def test_parts_can_be_added_to_the_selection(analyzed):
    labels = values_of(analyzed.data, "part")
    bpy.ops.eigenparts.select_part(part=3)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.eigenparts.select_part(part=1, extend=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    selected = [polygon.select for polygon in analyzed.data.polygons]
    np.testing.assert_array_equal(selected, np.isin(labels, [1, 3]))
