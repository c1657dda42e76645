"""Corrections by hand: what they do, and that they outlive whatever happens to the mesh."""

import bpy
import numpy as np
import pytest

from examples import humanoid
from examples.blender import add_posed_mesh
from tests.blender.conftest import everything_on, values_of


@pytest.fixture
def person(scene):
    """A humanoid at its default level: body and hips, legs, arms and head."""
    return scene(analyzed_humanoid)


def analyzed_humanoid():
    bpy.context.view_layer.objects.active = add_posed_mesh(humanoid())
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.segment(joints=False)


def labels_of(obj):
    return values_of(obj.data, "part")


def n_levels(obj):
    return obj.data["eigenparts_state"]["hierarchy"]["n_levels"]


def rows(obj):
    return {row.part: row for row in obj.data.eigenparts.rows}


def corrections_of(obj):
    return [(row.title, row.rests) for row in obj.data.eigenparts.correction_rows]


def arms(obj):
    """Return the two parts of most faces: hands are finer than the rest."""
    return sorted(rows(obj), key=lambda part: -rows(obj)[part].n_faces)[:2]


def correct_everything(obj):
    """Make one correction of each kind, and return the labels."""
    first, second = arms(obj)
    bpy.ops.eigenparts.set_branch_level(part=first, level=n_levels(obj) - 1)
    bpy.ops.eigenparts.split_part(part=second, position=0.3)
    bpy.ops.eigenparts.move_border(part=first, offset=-0.05)
    neighbour = next(part for part, row in rows(obj).items() if row.depth == 1)
    bpy.ops.eigenparts.merge_parts(part=neighbour, into=_parent_of(obj, neighbour))
    paint(obj, np.flatnonzero(labels_of(obj) == 0)[:40], new=True)
    return labels_of(obj)


def _parent_of(obj, part):
    parts = obj.data["eigenparts_state"]["parts"]
    ids, parents = (list(parts[name]["values"]) for name in ("id", "parent"))
    return int(parents[ids.index(part)])


def paint(obj, faces, **options):
    selection = np.zeros(len(obj.data.polygons), dtype=bool)
    selection[faces] = True
    obj.data.polygons.foreach_set("select", selection)
    bpy.ops.eigenparts.paint_part(**options)


def test_one_arm_can_be_finer_than_the_other(person):
    first, second = arms(person)
    before = labels_of(person)
    bpy.ops.eigenparts.set_branch_level(part=first, level=n_levels(person) - 1)
    after = labels_of(person)
    np.testing.assert_array_equal(after[before != first], before[before != first])
    assert len(set(after[before == first])) == 6
    assert (after == second).sum() == (before == second).sum()


def test_a_merged_part_leaves_no_face_and_nothing_else_moves(person):
    before = labels_of(person)
    first, _ = arms(person)
    bpy.ops.eigenparts.merge_parts(part=first, into=0)
    np.testing.assert_array_equal(labels_of(person), np.where(before == first, 0, before))
    assert person.data.eigenparts.n_parts == len(set(before)) - 1


def test_the_number_of_parts_counts_what_is_shown(person):
    first, _ = arms(person)
    bpy.ops.eigenparts.merge_parts(part=first, into=0)
    # The next level has two fingers more, and with them what is left of the hands.
    for n_parts in (5, 6, 10):
        person.data.eigenparts.n_parts = n_parts
        assert person.data.eigenparts.n_parts == len(set(labels_of(person))) == n_parts


def test_a_split_divides_one_part_and_the_tip_is_the_new_one(person):
    before = labels_of(person)
    first, _ = arms(person)
    bpy.ops.eigenparts.split_part(part=first, position=0.4)
    after = labels_of(person)
    (new,) = set(after) - set(before)
    np.testing.assert_array_equal(np.where(after == new, first, after), before)
    heights = values_of(person.data, ".eigenparts_height", dtype=np.float32)
    mean = np.array([heights[list(polygon.vertices)].mean() for polygon in person.data.polygons])
    assert mean[after == new].min() >= mean[after == first].max()


def test_a_border_moved_outward_grows_the_part_and_back_again_is_where_it_was(person):
    before = labels_of(person)
    first, _ = arms(person)
    sizes = []
    for offset in (-0.1, -0.05, 0.05, 0.1):
        bpy.ops.eigenparts.move_border(part=first, offset=offset)
        sizes.append((labels_of(person) == first).sum())
    assert sizes == sorted(set(sizes))
    assert sizes[1] < (before == first).sum() < sizes[2]
    bpy.ops.eigenparts.move_border(part=first, offset=0)
    np.testing.assert_array_equal(labels_of(person), before)
    assert corrections_of(person) == []


def test_painted_faces_belong_to_the_part(person):
    before = labels_of(person)
    first, _ = arms(person)
    faces = np.flatnonzero(before == 0)[:25]
    paint(person, faces, part=first)
    assert (labels_of(person)[faces] == first).all()
    person.data.eigenparts.level = n_levels(person) - 1
    assert (labels_of(person)[faces] == first).all()


def test_faces_are_painted_from_edit_mode(person):
    first, _ = arms(person)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.eigenparts.paint_part(part=first)
    assert person.mode == "OBJECT"
    assert set(labels_of(person)) == {first}


def test_corrections_rest_where_their_parts_are_missing_and_come_back(person):
    corrected = correct_everything(person)
    level = person.data.eigenparts.level
    person.data.eigenparts.level = 0
    assert all(rests for title, rests in corrections_of(person) if "painted" not in title)
    person.data.eigenparts.level = level
    np.testing.assert_array_equal(labels_of(person), corrected)
    assert not any(rests for _, rests in corrections_of(person))


def test_corrections_outlive_a_new_analysis(person):
    corrected = correct_everything(person)
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.segment(joints=False)
    np.testing.assert_array_equal(labels_of(person), corrected)


def test_corrections_find_their_parts_in_an_analysis_of_another_order(person):
    corrected, listed = correct_everything(person), corrections_of(person)
    bpy.ops.eigenparts.analyze(order="2")
    again = labels_of(person)
    assert len(corrections_of(person)) == len(listed)
    # The numbers may be others, the division is the same on nearly all faces.
    agreeing = sum(np.unique(again[corrected == part], return_counts=True)[1].max() for part in set(corrected))
    assert agreeing > 0.98 * len(corrected)
    assert len(set(again)) == len(set(corrected))


def test_corrections_are_saved(person, tmp_path):
    corrected = correct_everything(person)
    name, listed = person.name, corrections_of(person)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "person.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "person.blend"))
    loaded = bpy.data.objects[name]
    bpy.context.view_layer.objects.active = loaded
    assert corrections_of(loaded) == listed
    loaded.data.eigenparts.level = 1
    bpy.ops.eigenparts.segment()
    np.testing.assert_array_equal(labels_of(loaded), corrected)


def test_a_copy_has_corrections_of_its_own(person):
    corrected = correct_everything(person)
    copy = bpy.data.objects.new("copy", person.data.copy())
    bpy.context.collection.objects.link(copy)
    bpy.context.view_layer.objects.active = copy
    bpy.ops.eigenparts.clear_corrections()
    np.testing.assert_array_equal(labels_of(person), corrected)
    assert corrections_of(copy) == []
    assert len(corrections_of(person)) == 5


def test_undo_and_redo(person):
    first, _ = arms(person)
    name, before = person.name, labels_of(person)
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="analyzed")
        bpy.ops.eigenparts.merge_parts(part=first, into=0)
        bpy.ops.ed.undo_push(message="merged")
        merged = labels_of(bpy.data.objects[name])
        bpy.ops.ed.undo()
        np.testing.assert_array_equal(labels_of(bpy.data.objects[name]), before)
        assert corrections_of(bpy.data.objects[name]) == []
        bpy.ops.ed.redo()
    np.testing.assert_array_equal(labels_of(bpy.data.objects[name]), merged)
    assert len(corrections_of(bpy.data.objects[name])) == 1


def test_each_correction_can_be_removed_alone_and_all_at_once(person):
    before = labels_of(person)
    corrected = correct_everything(person)
    n_corrections = len(corrections_of(person))
    bpy.ops.eigenparts.remove_correction(index=n_corrections - 1)
    assert len(corrections_of(person)) == n_corrections - 1
    assert (labels_of(person) != corrected).sum() == 40
    for index in reversed(range(n_corrections - 1)):
        bpy.ops.eigenparts.remove_correction(index=index)
    np.testing.assert_array_equal(labels_of(person), before)
    correct_everything(person)
    bpy.ops.eigenparts.clear_corrections()
    np.testing.assert_array_equal(labels_of(person), before)
    assert not {"eigenparts_painted", ".eigenparts_piece"} & {a.name for a in person.data.attributes}


def test_the_panel_moves_level_and_border_of_the_active_part(person):
    first, _ = arms(person)
    settings = person.data.eigenparts
    settings.active_row = [row.part for row in settings.rows].index(first)
    settings.part_border = 0.08
    assert settings.part_border == pytest.approx(0.08)
    settings.part_level = 1000
    assert settings.part_level == n_levels(person) - 1
    assert [title for title, _ in corrections_of(person)] == [
        f"{rows(person)[first].title}: border +8.0%",
        f"{rows(person)[first].title}: level {n_levels(person) - 1}",
    ]


@pytest.mark.parametrize(
    ("action", "options", "sentence"),
    [
        ("merge_parts", {"part": 2, "into": 2}, "cannot be merged with itself"),
        ("merge_parts", {"part": 2, "into": 99}, "no part 99"),
        ("merge_parts", {"part": 2, "into": 4}, "do not touch"),
        ("split_part", {"part": 0}, "The body is what the parts leave"),
        ("split_part", {"part": 99}, "no part 99"),
        ("split_part", {"part": 2, "position": 1.0}, "between 0"),
        ("move_border", {"part": 0, "offset": 0.1}, "The body is what the parts leave"),
        ("move_border", {"part": 2, "offset": -1.0}, "changes nothing"),
        ("set_branch_level", {"part": 2, "level": 10**6}, "does not exist"),
        ("set_branch_level", {"part": 99, "level": 1}, "no part 99"),
        ("paint_part", {"part": 2}, "Select the faces"),
        ("paint_part", {"part": 99}, "no part 99"),
        ("remove_correction", {"index": 0}, "no correction 0"),
    ],
)
def test_what_makes_no_sense_is_refused_and_nothing_changes(person, action, options, sentence):
    person.data.polygons.foreach_set("select", np.zeros(len(person.data.polygons), dtype=bool))
    before = everything_on(person.data)
    with pytest.raises(RuntimeError, match=sentence):
        getattr(bpy.ops.eigenparts, action)(**options)
    assert everything_on(person.data) == before
    assert corrections_of(person) == []


def test_corrections_need_an_analysis(star_object):
    with pytest.raises(RuntimeError, match="Analyze the mesh first"):
        bpy.ops.eigenparts.merge_parts(part=1, into=0)


def damaged_text(group):
    group["0"]["kind"] = "import os"


def huge_part(group):
    group["0"]["part"] = 2**31 - 1


def no_number(group):
    group["0"]["value"] = float("nan")


def bare(group):
    group["0"] = 7


@pytest.mark.parametrize("damage", [damaged_text, huge_part, no_number, bare])
def test_a_correction_that_makes_no_sense_is_passed_over(person, damage):
    before = labels_of(person)
    first, _ = arms(person)
    bpy.ops.eigenparts.move_border(part=first, offset=0.1)
    damage(person.data["eigenparts_state"]["corrections"])
    bpy.ops.eigenparts.segment()
    np.testing.assert_array_equal(labels_of(person), before)


def test_a_state_of_the_first_version_is_read(person):
    before = labels_of(person)
    state = person.data["eigenparts_state"]
    state["schema"] = 1
    del state["corrections"]
    bpy.ops.eigenparts.segment(level=1)
    bpy.ops.eigenparts.segment()
    np.testing.assert_array_equal(labels_of(person), before)


def test_cutting_inserts_the_borders_where_corrections_put_them(person):
    bpy.ops.eigenparts.analyze(borders="EXACT")
    first, second = arms(person)
    bpy.ops.eigenparts.move_border(part=first, offset=-0.07)
    bpy.ops.eigenparts.split_part(part=first, position=0.5)
    bpy.ops.eigenparts.merge_parts(part=second, into=0)
    area = {part: row.share for part, row in rows(person).items()}
    bpy.ops.eigenparts.cut()
    assert set(rows(person)) == set(area)
    for part, row in rows(person).items():
        assert row.share == pytest.approx(area[part], abs=0.01)
    labels, heights = labels_of(person), values_of(person.data, ".eigenparts_height", dtype=np.float32)
    inner, outer = (
        {v for polygon in person.data.polygons if labels[polygon.index] == part for v in polygon.vertices}
        for part in (max(area), first)
    )
    border = heights[sorted(inner & outer)]
    assert len(border) > 10
    assert np.ptp(border) < 0.01 * np.ptp(heights)


def test_borders_along_edges_keep_corrections(person):
    first, second = arms(person)
    bpy.ops.eigenparts.merge_parts(part=second, into=0)
    present = set(labels_of(person))
    bpy.ops.eigenparts.cut(method="EXISTING")
    moved = labels_of(person)
    assert set(moved) == present
    bpy.ops.eigenparts.segment()
    np.testing.assert_array_equal(labels_of(person), moved)
    assert first in moved


def twins_of(obj):
    parts = obj.data["eigenparts_state"]["parts"]
    ids, mirror = (list(parts[name]["values"]) for name in ("id", "mirror"))
    return {part: twin for part, twin in zip(ids, mirror, strict=True) if twin >= 0}


def share_of(obj, part):
    return rows(obj)[part].share


def test_what_is_done_to_a_part_is_done_to_its_twin(person):
    part, twin = next(iter(twins_of(person).items()))
    bpy.ops.eigenparts.split_part(part=part, position=0.3, mirror=True)
    assert share_of(person, part) == pytest.approx(share_of(person, twin), rel=0.05)
    first, second = sorted(rows(person))[-2:]
    bpy.ops.eigenparts.move_border(part=first, offset=-0.1, mirror=True)
    assert share_of(person, first) == pytest.approx(share_of(person, second), rel=0.05)
    bpy.ops.eigenparts.merge_parts(part=first, into=part, mirror=True)
    assert not {first, second} & set(rows(person))
    assert share_of(person, part) == pytest.approx(share_of(person, twin), rel=0.05)


def test_the_tick_of_the_panel_counts_for_borders_and_operators(person):
    part, twin = next(iter(twins_of(person).items()))
    settings = person.data.eigenparts
    settings.mirror = True
    settings.active_row = next(row for row, other in enumerate(settings.rows) if other.part == part)
    before = share_of(person, part), share_of(person, twin)
    settings.part_border = -0.1
    assert share_of(person, part) < before[0]
    assert share_of(person, twin) < before[1]
    bpy.ops.eigenparts.split_part(part=part)
    assert len(corrections_of(person)) == 4
    bpy.ops.eigenparts.split_part(part=part, mirror=False)
    assert len(corrections_of(person)) == 5


def test_twins_are_merged_with_the_body_whichever_is_named_first(person):
    first, second = arms(person)
    before = labels_of(person)
    bpy.ops.eigenparts.merge_parts(part=0, into=first, mirror=True)
    np.testing.assert_array_equal(labels_of(person), np.where(np.isin(before, [first, second]), 0, before))


def test_a_part_without_a_twin_is_corrected_alone(person):
    part = next(part for part in rows(person) if part and part not in twins_of(person))
    bpy.ops.eigenparts.split_part(part=part, mirror=True)
    assert len(corrections_of(person)) == 1


def test_a_twin_that_cannot_be_corrected_leaves_both_as_they_were(person, monkeypatch):
    from eigenparts.operators.corrections import split

    part, twin = next(iter(twins_of(person).items()))
    own = split.split_part

    def refusing(state, number, position):
        if number == twin:
            raise split.Refusal("The twin cannot be split.")
        return own(state, number, position)

    monkeypatch.setattr(split, "split_part", refusing)
    before = everything_on(person.data)
    with pytest.raises(RuntimeError, match="twin cannot be split"):
        bpy.ops.eigenparts.split_part(part=part, mirror=True)
    assert everything_on(person.data) == before
