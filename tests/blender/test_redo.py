"""The panel of the last operation: what is changed there gives what the first run with it would have given."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import everything_on, values_of

QUICK = {
    *("segment", "select_part", "merge_parts", "split_part", "move_border", "set_branch_level", "paint_part"),
    *("remove_correction", "clear_corrections", "write_outputs", "cut", "separate", "clear"),
    # These need an analysis, but the last one is kept.
    *("create_armature", "create_skeleton_curves"),
}
# Seconds in which the window would be frozen, as what is changed afterwards does not run in the background.
HEAVY = {
    *("analyze", "register_selected", "flip_function", "next_alternative", "transfer"),
    *("write_eigenfunctions", "plot_diagram", "trace_complex"),
    # End when the user is done with clicking, or stand beside what they change; there is nothing to be changed then.
    *("pick_part", "add_point_pair", "remove_point_pair", "clear_point_pairs"),
}
INTERNAL = {"cancel", "reset_colors", "add_analysis_preset", "add_transfer_preset"}
# Changes nothing, so there is nothing to undo or to do again.
TELLING = {"copy_report"}


def options_of(name):
    # Blender keeps the class of an operator under this name.
    return getattr(bpy.types, f"EIGENPARTS_OT_{name}").bl_options


@pytest.mark.parametrize(
    ("names", "options"),
    [(QUICK, {"REGISTER", "UNDO"}), (HEAVY, {"UNDO"}), (INTERNAL, {"INTERNAL"}), (TELLING, set())],
)
def test_what_can_be_changed_afterwards_is_what_is_quick(extension, names, options):
    assert {name: options_of(name) for name in names} == dict.fromkeys(names, options)


def test_every_operator_is_one_of_these(extension):
    assert set(dir(bpy.ops.eigenparts)) == QUICK | HEAVY | INTERNAL | TELLING


class Undoable:
    """Blender with its steps of undo."""

    def __init__(self):
        window = bpy.context.window_manager.windows[0]
        self._context = bpy.context.temp_override(window=window, screen=window.screen)

    def __enter__(self):
        self._context.__enter__()
        bpy.ops.ed.undo_push(message="before")
        return self

    def __exit__(self, *error):
        self._context.__exit__(*error)

    def run(self, name, **options):
        """Run an operator as a step of its own, and return the properties that its panel shows."""
        assert getattr(bpy.ops.eigenparts, name)("EXEC_DEFAULT", True, **options) == {"FINISHED"}
        properties = bpy.context.window_manager.operators[-1].properties
        assert properties.bl_rna.identifier == f"EIGENPARTS_OT_{name}"
        names = [entry.identifier for entry in properties.bl_rna.properties if entry.identifier != "rna_type"]
        return {name: getattr(properties, name) for name in names if properties.is_property_set(name)}

    def run_again(self, name, shown, **changed):
        """Change something in the panel: Blender undoes the last operation and runs it with all that is shown."""
        bpy.ops.ed.undo()
        return self.run(name, **(shown | changed))


def left_by(obj_name="star"):
    """Return all that is in the file after an operation."""
    obj = bpy.data.objects[obj_name]
    if obj.mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
    selected = [polygon.select for polygon in obj.data.polygons]
    bones = [(bone.name, *bone.head_local, *bone.tail_local) for rig in bpy.data.armatures for bone in rig.bones]
    groups = [group.name for group in obj.vertex_groups]
    return everything_on(obj.data), selected, sorted(bones), groups, sorted(bpy.data.objects.keys())


@pytest.mark.parametrize(
    ("name", "first", "changed"),
    [
        ("segment", {}, {"by": "LEVEL", "level": 2}),
        ("segment", {"level": 3}, {"level": 1}),
        ("segment", {"n_parts": 3}, {"n_parts": 5}),
        ("segment", {"n_parts": 3}, {"by": "THRESHOLD", "threshold": 0.5}),
        ("segment", {"level": 1}, {"by": "DEFAULT"}),
        ("segment", {"level": 1}, {"mode": "FEATURES"}),
        ("select_part", {"part": 1}, {"part": 2}),
        ("merge_parts", {"part": 1, "into": 0}, {"part": 2}),
        ("split_part", {"part": 1, "position": 0.5}, {"position": 0.3}),
        ("move_border", {"part": 1, "offset": 0.1}, {"offset": -0.1}),
        ("write_outputs", {"outputs": {"FACE_SETS"}}, {"outputs": {"MATERIALS", "VERTEX_GROUPS"}, "softness": 0.2}),
        ("cut", {"method": "INSERT"}, {"method": "EXISTING"}),
        ("create_armature", {"weights": "PARTS"}, {"bones_in_limbs": 3, "weights": "NONE"}),
        ("create_skeleton_curves", {}, {"bones_in_limbs": 1}),
    ],
)
def test_a_change_afterwards_is_the_same_as_a_first_run_with_it(analyzed, name, first, changed):
    with Undoable() as blender:
        shown = blender.run(name, **first)
        blender.run_again(name, shown, **changed)
        again = left_by()
        bpy.ops.ed.undo()
        blender.run(name, **(first | changed))
        assert left_by() == again


def test_faces_are_given_to_another_part_afterwards(analyzed):
    labels = values_of(analyzed.data, "part")
    bpy.ops.eigenparts.select_part(part=1)
    with Undoable() as blender:
        shown = blender.run("paint_part", part=0)
        bpy.ops.ed.undo()
        assert bpy.context.mode == "EDIT_MESH"
        blender.run("paint_part", **(shown | {"part": 2}))
        np.testing.assert_array_equal(
            values_of(bpy.data.objects["star"].data, "part"), np.where(labels == 1, 2, labels)
        )


def test_the_panel_of_segment_begins_with_what_the_mesh_shows(analyzed):
    with Undoable() as blender:
        shown = blender.run("segment")
        assert shown == {
            "by": "DEFAULT",
            "mode": "NESTED",
            "joints": True,
            "level": analyzed.data.eigenparts.level,
            "n_parts": 6,
        }
        shown = blender.run("segment", n_parts=3)
        assert (shown["by"], shown["n_parts"], shown["level"]) == ("N_PARTS", 3, analyzed.data.eigenparts.level)


def test_the_threshold_begins_where_the_default_level_is(extension):
    entry = bpy.ops.eigenparts.segment.get_rna_type().properties["threshold"]
    assert entry.default == pytest.approx(extension.compute.DEFAULT_THRESHOLD)


def test_bones_after_an_analysis_need_no_other_one(analyzed, extension, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("analyzed again")

    monkeypatch.setattr(extension.compute, "analyze", refuse, raising=False)
    assert bpy.ops.eigenparts.create_skeleton_curves() == {"FINISHED"}
    analyzed.data.vertices[0].co.x += 0.01
    with pytest.raises((AssertionError, RuntimeError)):
        bpy.ops.eigenparts.create_skeleton_curves()


class TestWithoutBeingToldAboutWhich:
    """As from the menu: what is done is done to the part that is active in the list."""

    @pytest.fixture
    def second(self, analyzed):
        settings = analyzed.data.eigenparts
        settings.active_row = [row.part for row in settings.rows].index(2)
        return analyzed

    def test_the_active_part_is_merged_into_the_one_it_grows_out_of(self, second):
        before = values_of(second.data, "part")
        bpy.ops.eigenparts.merge_parts()
        np.testing.assert_array_equal(values_of(second.data, "part"), np.where(before == 2, 0, before))

    def test_the_border_of_the_active_part_begins_where_it_is(self, second):
        bpy.ops.eigenparts.move_border(part=2, offset=0.1)
        before = values_of(second.data, "part")
        bpy.ops.eigenparts.move_border()
        np.testing.assert_array_equal(values_of(second.data, "part"), before)

    def test_there_must_be_one(self, analyzed):
        for name in ("merge_parts", "split_part", "move_border", "set_branch_level", "select_part"):
            with pytest.raises(RuntimeError, match="Click a part in the list first"):
                getattr(bpy.ops.eigenparts, name)()
