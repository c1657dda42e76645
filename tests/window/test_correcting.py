"""Correct by Hand in the window: parts split, joined and painted, and the level afterwards."""

from tests.window.conftest import labels, unfold

SETTINGS = "bpy.context.object.data.eigenparts"


def correct(window, action, **options):
    window.run(f"with over_view(): bpy.ops.eigenparts.{action}('INVOKE_DEFAULT', True, **{options})")


def arm(window):
    """The part of most faces: hands are finer than the rest."""
    return window.value(f"max({SETTINGS}.rows, key=lambda row: row.n_faces).part")


def select_the_belly(window):
    """Draw a box over it in edit mode, and return the numbers of the faces."""
    window.press("TAB")
    window.wait_for("bpy.context.mode == 'EDIT_MESH'")
    window.run("bpy.context.tool_settings.mesh_select_mode = (False, False, True)")
    window.drag(window.place((-0.06, 0, 0.98)), window.place((0.06, 0, 1.16)))
    window.settle()
    return window.value(
        "bpy.context.object.update_from_editmode() and "
        "[face.index for face in bpy.context.object.data.polygons if face.select]"
    )


def test_a_part_is_split_and_joined_again(pair, show):
    before, part = labels(pair), arm(pair)
    pair.run(f"{SETTINGS}.active_part = {part}")
    correct(pair, "split_part", part=part)
    unfold(pair, "Parts", "Correct by Hand")
    show("corrected")
    (new,) = set(labels(pair)) - set(before)
    correct(pair, "merge_parts", part=new, into=part)
    assert labels(pair) == before


def test_faces_selected_in_edit_mode_become_a_part_that_outlives_the_level(pair, take):
    before = labels(pair)
    belly = select_the_belly(pair)
    take("belly_selected")
    correct(pair, "paint_part", new=True)
    after = labels(pair)
    assert [face for face, (was, now) in enumerate(zip(before, after, strict=True)) if was != now] == belly
    take("belly_painted")
    level = pair.value(f"{SETTINGS}.level")
    for moved in (0, level):
        pair.run(f"{SETTINGS}.level = {moved}")
    assert labels(pair) == after


def test_undo_takes_a_correction_back(pair):
    before, part = labels(pair), arm(pair)
    correct(pair, "split_part", part=part)
    assert labels(pair) != before
    pair.press("Z", ctrl=True)
    pair.wait_for(f"len({SETTINGS}.correction_rows) == 0")
    assert labels(pair) == before
