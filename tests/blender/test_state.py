"""The state on the mesh: it survives what Blender does to meshes, and what cannot be trusted is refused."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import values_of


def segmented_at(obj, level):
    bpy.context.view_layer.objects.active = obj
    bpy.ops.eigenparts.segment(level=level)
    return values_of(obj.data, "part")


@pytest.fixture
def labels_at_two(analyzed):
    return segmented_at(analyzed, 2)


def test_levels_work_after_saving_and_loading(analyzed, labels_at_two, tmp_path):
    bpy.ops.eigenparts.segment(level=1)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "star.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "star.blend"))
    loaded = bpy.data.objects["star"]
    assert loaded.data.eigenparts.level == 1
    np.testing.assert_array_equal(segmented_at(loaded, 2), labels_at_two)


def test_levels_work_on_a_copy_and_leave_the_original(analyzed, labels_at_two):
    copy = bpy.data.objects.new("copy", analyzed.data.copy())
    bpy.context.collection.objects.link(copy)
    segmented_at(copy, 1)
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), labels_at_two)
    np.testing.assert_array_equal(segmented_at(copy, 2), labels_at_two)


def test_undo_brings_back_the_level_before(analyzed, labels_at_two):
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="level 2")
        bpy.ops.eigenparts.segment(level=1)
        bpy.ops.ed.undo_push(message="level 1")
        bpy.ops.ed.undo()
    undone = bpy.data.objects["star"]
    assert undone.data.eigenparts.level == 2
    np.testing.assert_array_equal(values_of(undone.data, "part"), labels_at_two)
    np.testing.assert_array_equal(segmented_at(undone, 2), labels_at_two)


def test_a_moved_vertex_is_noticed(analyzed):
    analyzed.data.vertices[7].co.x += 0.01
    with pytest.raises(RuntimeError, match="changed after it was analyzed"):
        bpy.ops.eigenparts.segment(level=1)


def test_a_deleted_face_is_noticed(analyzed):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    analyzed.data.polygons[0].select = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.delete(type="ONLY_FACE")
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(RuntimeError, match="changed after it was analyzed"):
        bpy.ops.eigenparts.segment(level=1)


def test_the_panel_says_what_the_slider_cannot(analyzed):
    analyzed.data.vertices[7].co.x += 0.01
    analyzed.data.eigenparts.level = 1
    assert "changed after it was analyzed" in bpy.context.window_manager.eigenparts.problem
    assert bpy.context.window_manager.eigenparts.problem_of == analyzed.data.name_full
    bpy.ops.eigenparts.analyze()
    assert bpy.context.window_manager.eigenparts.problem == ""


def test_the_level_is_refused_in_edit_mode(analyzed, labels_at_two):
    bpy.ops.object.mode_set(mode="EDIT")
    analyzed.data.eigenparts.level = 1
    assert "Leave edit mode" in bpy.context.window_manager.eigenparts.problem
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), labels_at_two)


def state_of(obj):
    return obj.data["eigenparts_state"]


def take_branches_away(obj):
    obj.data.attributes.remove(obj.data.attributes["eigenparts_branch"])


def point_a_branch_nowhere(obj):
    obj.data.attributes["eigenparts_branch"].data[0].value = 10**6


def shorten_an_array(obj):
    state_of(obj)["tree_0"]["parent"]["values"] = [-1]


def close_a_loop_in_the_tree(obj):
    state_of(obj)["tree_0"]["parent"]["values"] = [0] * len(state_of(obj)["tree_0"]["part"]["values"])


def drop_a_table(obj):
    del state_of(obj)["branches_0"]


def claim_an_odd_type(obj):
    state_of(obj)["hierarchy"]["pairs"]["dtype"] = "object"


def put_text_for_numbers(obj):
    state_of(obj)["branches_0"]["arc"]["values"] = "import os"


def name_a_huge_part(obj):
    state_of(obj)["tree_0"]["part"]["values"] = [2**31 - 1] * len(state_of(obj)["tree_0"]["part"]["values"])


def close_below_all_levels(obj):
    state_of(obj)["tree_0"]["closing"]["values"] = [-7] * len(state_of(obj)["tree_0"]["part"]["values"])


def point_a_twin_nowhere(obj):
    tree = state_of(obj)["tree_0"]
    tree["twin"]["values"] = [10**6] * len(tree["part"]["values"])


def close_at_necks_that_are_saddles(obj):
    tree = state_of(obj)["tree_0"]
    tree["neck"]["values"] = list(range(len(tree["part"]["values"])))
    tree["n_necks"] = len(tree["part"]["values"])


def drop_a_measure(obj):
    del state_of(obj)["tree_0"]["roundness"]


def leave_a_bare_number(obj):
    obj.data["eigenparts_state"] = 7


@pytest.mark.parametrize(
    "damage",
    [
        take_branches_away,
        point_a_branch_nowhere,
        shorten_an_array,
        close_a_loop_in_the_tree,
        drop_a_table,
        claim_an_odd_type,
        put_text_for_numbers,
        name_a_huge_part,
        close_below_all_levels,
        point_a_twin_nowhere,
        close_at_necks_that_are_saddles,
        drop_a_measure,
        leave_a_bare_number,
    ],
)
def test_a_damaged_state_is_refused_until_the_next_analysis(analyzed, labels_at_two, damage):
    damage(analyzed)
    with pytest.raises(RuntimeError, match=r"analyze (it|the mesh) again"):
        bpy.ops.eigenparts.segment(level=2)
    bpy.ops.eigenparts.analyze()
    np.testing.assert_array_equal(segmented_at(analyzed, 2), labels_at_two)


def test_the_columns_of_a_state_are_those_that_saved_files_have(analyzed):
    """Files of version 2 of the schema are read by these names."""
    state = state_of(analyzed)
    assert state["schema"] == 2
    tree = {"is_of_maxima", "n_roots", "n_features", "parent", "part", "extremum", "saddle", "closing"}
    tree |= {"joint_part", "joint_closing", "twin", "neck", "neck_closing", "n_necks"}
    assert set(state["tree_0"].keys()) == tree | {"height", "closing_length", "longest", "widest", "roundness"}
    assert set(state["branches_0"].keys()) == {"arc", "shown", "area", "n_faces", "borders", "border_length"}
    assert set(state["hierarchy"].keys()) == {"pairs", "persistence", "is_maximum", "value_range", "n_levels"}
    closing, parent = (np.array(state["tree_0"][column]["values"]) for column in ("closing", "parent"))
    assert closing[parent == -1].tolist() == [2**31 - 1]
    assert np.isnan(np.array(state["closing_heights_0"]["values"])[parent == -1]).all()


def test_a_newer_version_is_refused(analyzed):
    state_of(analyzed)["schema"] = 1000
    with pytest.raises(RuntimeError, match="newer version"):
        bpy.ops.eigenparts.segment(level=1)


def test_a_new_analysis_replaces_all_of_the_old_one(analyzed):
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=1)
    bpy.ops.eigenparts.analyze(field="DIFFUSION")
    assert "eigenparts_branch_minima" not in analyzed.data.attributes
    assert "tree_1" not in state_of(analyzed)
