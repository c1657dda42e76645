"""The list of parts: names and colours stay with their part."""

from itertools import pairwise

import bpy
import numpy as np
import pytest

from examples import humanoid
from examples.blender import add_posed_mesh
from tests.blender.conftest import values_of


def rows(obj):
    return {row.part: row for row in obj.data.eigenparts.rows}


def titles(obj):
    return {row.part: row.title for row in obj.data.eigenparts.rows}


@pytest.fixture
def nested(scene):
    """A humanoid, where limbs hang on a torso and fingers on hands."""
    return scene(analyzed_humanoid)


def analyzed_humanoid():
    bpy.context.view_layer.objects.active = add_posed_mesh(humanoid())
    bpy.ops.eigenparts.analyze()
    # Joints come between parts and those inside them, which keep the name that they were given first.
    bpy.ops.eigenparts.segment(joints=False)


def test_the_list_tells_area_and_faces(analyzed):
    labels = values_of(analyzed.data, "part")
    assert sum(row.share for row in analyzed.data.eigenparts.rows) == pytest.approx(1)
    assert {part: row.n_faces for part, row in rows(analyzed).items()} == dict(
        zip(*(column.tolist() for column in np.unique(labels, return_counts=True)), strict=True)
    )


def test_parts_of_parts_follow_them_and_carry_their_name(nested):
    nested.data.eigenparts.level = 1000
    listed = list(nested.data.eigenparts.rows)
    assert max(row.depth for row in listed) >= 1
    for above, row in pairwise(listed):
        assert row.depth <= above.depth + 1
        if row.depth == above.depth + 1:
            assert row.title.startswith(above.title + ".")
    assert len({row.title for row in listed}) == len(listed)


def colours(obj):
    return {row.part: tuple(row.color) for row in obj.data.eigenparts.rows}


def test_parts_keep_their_colours_and_no_two_that_are_shown_look_alike(nested):
    seen = {}
    for level in range(nested.data["eigenparts_state"]["hierarchy"]["n_levels"]):
        nested.data.eigenparts.level = level
        shown = colours(nested)
        assert len(set(shown.values())) == len(shown)
        assert all(seen.setdefault(part, colour) == colour for part, colour in shown.items())


def test_a_part_that_is_split_off_and_one_that_is_painted_look_like_no_other(nested):
    before = colours(nested)
    first, second = (row.part for row in sorted(nested.data.eigenparts.rows, key=lambda row: -row.n_faces)[:2])
    bpy.ops.eigenparts.split_part(part=first)
    bpy.ops.eigenparts.split_part(part=second)
    after = colours(nested)
    assert len(after) == len(before) + 2 == len(set(after.values()))
    assert after.items() >= before.items()


def test_swatches_that_make_no_sense_are_passed_over(nested):
    for wrong in ([2], [0, 3, 5, -7, 1, 2**31 - 1, -4, 2], {"1": 2}, "red", [0.5, 1.5]):
        nested.data["eigenparts_state"]["part_swatches"] = wrong
        assert len(colours(nested)) == len(nested.data.eigenparts.rows)
        bpy.ops.eigenparts.segment(level=3)
        assert len(set(colours(nested).values())) == len(colours(nested))


def test_a_name_never_changes_by_itself(nested):
    at_default = titles(nested)
    nested.data.eigenparts.level = 1000
    at_highest = titles(nested)
    nested.data.eigenparts.level = 1
    assert titles(nested).items() <= {**at_highest, **at_default}.items()
    assert at_default.items() <= {**at_highest, **at_default}.items()
    bpy.ops.eigenparts.analyze()
    assert titles(nested) == at_default


def test_a_name_the_user_gives_stays_and_passes_on_to_parts_inside(nested):
    child = next(row for row in nested.data.eigenparts.rows if row.depth == 1)
    parent = next(row for row in nested.data.eigenparts.rows if child.title.startswith(row.title + "."))
    part, inner = parent.part, child.part
    parent.title = "Chest"
    nested.data.eigenparts.level = 1000
    bpy.ops.eigenparts.analyze()
    assert titles(nested)[part] == "Chest"
    assert titles(nested)[inner].startswith("Chest.")


def test_names_are_unique_and_an_empty_one_brings_the_first_back(analyzed):
    rows(analyzed)[1].title = "Arm"
    rows(analyzed)[2].title = "Arm"
    assert titles(analyzed)[2] == "Arm.001"
    rows(analyzed)[1].title = ""
    assert titles(analyzed)[1] == "Part 1"


def test_groups_and_materials_take_a_new_name(analyzed):
    bpy.ops.eigenparts.write_outputs(outputs={"VERTEX_GROUPS", "MATERIALS"})
    rows(analyzed)[2].title = "Arm"
    assert "Arm" in analyzed.vertex_groups
    assert "Arm" in analyzed.data.materials
    assert "Part 2" not in analyzed.vertex_groups


def test_a_colour_the_user_gives_is_shown_and_stays(analyzed):
    rows(analyzed)[2].color = (0.25, 0.5, 0.75)
    bpy.ops.eigenparts.segment(level=2)
    bpy.ops.eigenparts.segment()
    colours = values_of(analyzed.data, "part_color", 4, np.float32, "color").reshape(-1, 3, 4)[:, 0]
    shown = np.unique(colours[values_of(analyzed.data, "part") == 2], axis=0)
    np.testing.assert_allclose(shown, [[0.25, 0.5, 0.75, 1.0]])


def test_a_click_selects_the_faces_of_the_part(analyzed):
    settings = analyzed.data.eigenparts
    settings.active_row = [row.part for row in settings.rows].index(3)
    selected = [polygon.select for polygon in analyzed.data.polygons]
    np.testing.assert_array_equal(selected, values_of(analyzed.data, "part") == 3)
    bpy.ops.object.mode_set(mode="EDIT")
    settings.active_row = [row.part for row in settings.rows].index(1)
    bpy.ops.object.mode_set(mode="OBJECT")
    selected = [polygon.select for polygon in analyzed.data.polygons]
    np.testing.assert_array_equal(selected, values_of(analyzed.data, "part") == 1)


def test_names_that_make_no_sense_are_passed_over(analyzed):
    analyzed.data["eigenparts_state"]["part_names"] = {"1": 7, "x": "y"}
    analyzed.data["eigenparts_state"]["part_colours"] = {"2": "red"}
    analyzed.data["eigenparts_state"]["part_numbers"] = {"1": [2, 1], "2": [1, 1]}
    before = rows(analyzed)[3].color.copy()
    bpy.ops.eigenparts.segment(level=2)
    assert titles(analyzed)[0] == "Body"
    assert all(title.startswith("Part") for part, title in titles(analyzed).items() if part)
    assert rows(analyzed)[3].color == before


def named_arm(obj):
    rows(obj)[2].title = "Arm"
    rows(obj)[2].color = (0.25, 0.5, 0.75)


def test_names_and_colours_survive_saving_and_loading(analyzed, tmp_path):
    named_arm(analyzed)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "star.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "star.blend"))
    loaded = bpy.data.objects["star"]
    assert titles(loaded)[2] == "Arm"
    assert tuple(rows(loaded)[2].color) == (0.25, 0.5, 0.75)


def test_a_copy_has_names_of_its_own(analyzed):
    named_arm(analyzed)
    copy = bpy.data.objects.new("copy", analyzed.data.copy())
    rows(copy)[2].title = "Leg"
    assert (titles(analyzed)[2], titles(copy)[2]) == ("Arm", "Leg")


def test_undo_brings_the_name_before_back(analyzed):
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="analyzed")
        named_arm(analyzed)
        bpy.ops.ed.undo_push(message="named")
        bpy.ops.ed.undo()
    assert titles(bpy.data.objects["star"])[2] == "Part 2"


def with_all_inside(obj):
    """Return for each part that is shown the mask of the faces in it and in all that grows out of it."""
    labels = values_of(obj.data, "part")
    inside, around = {}, []
    for row in obj.data.eigenparts.rows:
        around = [*around[: row.depth], row.part]
        for part in around:
            inside[part] = inside.get(part, np.zeros(len(labels), dtype=bool)) | (labels == row.part)
    return inside


def every_division(obj):
    for mode in ("NESTED", "FEATURES"):
        for level in range(obj.data["eigenparts_state"]["hierarchy"]["n_levels"]):
            bpy.ops.eigenparts.segment(level=level, mode=mode)
            yield level, mode


def test_a_name_stays_on_its_piece_of_surface(nested):
    """Whatever number that has at another level or in another mode; no other piece gets the name."""
    default = nested.data.eigenparts.level
    named = {part: faces for part, faces in with_all_inside(nested).items() if part}
    for part in named:
        rows(nested)[part].title = f"Name {part}"
    for _ in every_division(nested):
        shown, inside = titles(nested), with_all_inside(nested)
        for part, faces in named.items():
            found = [other for other, title in shown.items() if title == f"Name {part}"]
            same = [
                other for other, own in inside.items() if other and (own & faces).sum() > 0.99 * (own | faces).sum()
            ]
            assert found == same
    bpy.ops.eigenparts.segment(level=default, mode="NESTED")
    assert titles(nested).items() >= {part: f"Name {part}" for part in named}.items()


def test_names_of_pieces_outlive_a_new_analysis(nested):
    part = next(part for part in rows(nested) if part)
    rows(nested)[part].title = "Named"
    faces = with_all_inside(nested)[part]
    nested.data.eigenparts.level = 0
    bpy.context.scene.eigenparts.order = "1"
    bpy.ops.eigenparts.analyze()
    (again,) = (part for part, title in titles(nested).items() if title == "Named")
    own = with_all_inside(nested)[again]
    assert (own & faces).sum() > 0.9 * (own | faces).sum()


def test_names_outlive_a_new_analysis_on_other_levels_and_in_other_modes(nested):
    bpy.ops.eigenparts.segment(mode="FEATURES")
    for part in filter(None, rows(nested)):
        rows(nested)[part].title = f"Name {part}"
    shown = titles(nested)
    bpy.ops.eigenparts.segment(mode="NESTED")
    others = titles(nested)
    bpy.ops.eigenparts.analyze()
    assert titles(nested) == others
    bpy.ops.eigenparts.segment(mode="FEATURES")
    assert titles(nested) == shown


def test_a_name_that_is_taken_back_is_gone_at_every_level(nested):
    part = next(part for part in rows(nested) if part)
    first = titles(nested)[part]
    rows(nested)[part].title = "Named"
    rows(nested)[part].title = ""
    assert titles(nested)[part] == first
    for _ in every_division(nested):
        assert "Named" not in titles(nested).values()
