"""What a user does with parts in the window: level, undo, redo, save, load, registering."""

import numpy as np

from tests.window.conftest import add_character, analyze, choose, labels, nearest_quads, select, unfold

LEVEL = "bpy.context.object.data.eigenparts.level"


def test_the_level_can_be_moved_and_the_view_follows(pair, show, take):
    show("analyzed")
    at_default, n_parts = pair.pixels(), len(set(labels(pair)))
    pair.run(f"{LEVEL} = 1")
    take("level_1")
    assert len(set(labels(pair))) == pair.value("bpy.context.object.data.eigenparts.n_parts") < n_parts
    assert (pair.pixels() != at_default).any(axis=2).mean() > 0.01


def test_undo_and_redo_take_the_analysis_back_and_forth(window, hand):
    add_character(window, hand)
    window.run("with over_view(): bpy.ops.ed.undo_push(message='Import')")
    analyze(window)
    parts = labels(window)
    window.press("Z", ctrl=True)
    window.wait_for("'eigenparts_state' not in bpy.context.object.data")
    assert not window.value("'part' in bpy.context.object.data.attributes")
    window.press("Z", ctrl=True, shift=True)
    window.wait_for("'eigenparts_state' in bpy.context.object.data")
    assert labels(window) == parts


def test_the_level_moves_after_saving_and_loading_without_a_new_analysis(window, hand):
    add_character(window, hand)
    analyze(window)
    parts, level = labels(window), window.value(LEVEL)
    path = str(window.folder / "hand.blend")
    window.run(f"bpy.ops.wm.save_as_mainfile(filepath={path!r})")
    window.run(f"bpy.ops.wm.open_mainfile(filepath={path!r})")
    window.settle()
    assert labels(window) == parts
    window.run(f"{LEVEL} = 0")
    assert set(labels(window)) == {0}
    window.run(f"{LEVEL} = {level}")
    assert labels(window) == parts


def test_two_characters_get_the_same_parts(window, hand, take):
    add_character(window, hand, "rest")
    add_character(window, hand, "fist", shift=0.25)
    window.run(
        "with over_view():\n"
        "    bpy.ops.object.select_all(action='SELECT')\n"
        "    bpy.context.view_layer.objects.active = bpy.data.objects['hand rest']\n"
        "    bpy.ops.view3d.view_all()"
    )
    choose(window, "register selected")
    window.wait_for("'part' in bpy.data.objects['hand fist'].data.attributes")
    window.settle()
    take("registered")
    rest, fist = (labels(window, f"bpy.data.objects['hand {pose}'].data") for pose in ("rest", "fist"))
    # The faces are the same, so labels can be compared one by one.
    assert sum(a == b for a, b in zip(rest, fist, strict=True)) > 0.95 * len(rest)


def test_a_pose_with_other_faces_gets_the_same_parts_in_the_same_places(pair, humanoid, walker, show, take):
    select(pair, "humanoid walk", "humanoid rest")
    unfold(pair, "Register")
    choose(pair, "register selected")
    pair.wait_for("bpy.context.window_manager.eigenparts.is_running")
    # Its progress is in the panel Register, and nowhere else.
    assert pair.value("bpy.context.window_manager.eigenparts.job") == "eigenparts.register_selected"
    take("registering")
    # Seconds; on a busy machine, matching by shape takes a while.
    pair.wait_for("'part' in bpy.data.objects['humanoid walk'].data.attributes", 400.0)
    unfold(pair, "Level", "Parts", "Register")
    show("registered")
    expected = np.array(labels(pair))[nearest_quads(humanoid, walker)]
    assert (np.array(labels(pair, "bpy.data.objects['humanoid walk'].data")) == expected).mean() > 0.95
