"""Colours, threads and presets that the user prefers, and the menu that has all actions."""

import ctypes
from pathlib import Path

import bpy
import numpy as np
import pytest

from tests.blender.conftest import values_of

PRESETS = Path(__file__).parents[2] / "presets" / "eigenparts"
OF_ANALYSIS = sorted((PRESETS / "analysis").glob("*.py"))
OF_TRANSFER = sorted((PRESETS / "transfer").glob("*.py"))


@pytest.fixture
def palette(extension):
    from eigenparts.operators.mesh_state import palette

    yield palette
    palette.use_colours(palette.standard_colours())


@pytest.fixture
def preferences(palette):
    """The preferences as they are where Eigenparts is installed."""
    addon = bpy.context.preferences.addons.new()
    addon.module = "eigenparts"
    yield addon.preferences
    bpy.context.preferences.addons.remove(addon)


def corners_with_colours(obj):
    """Return the part and the colour of each corner."""
    labels = values_of(obj.data, "part")
    corners = np.repeat(labels, [polygon.loop_total for polygon in obj.data.polygons])
    return corners, values_of(obj.data, "part_color", 4, np.float32, "color")[:, :3]


def test_preferred_colours_are_those_of_a_division(palette, analyzed):
    palette.use_colours([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    bpy.ops.eigenparts.segment()
    corners, colours = corners_with_colours(analyzed)
    np.testing.assert_array_equal(colours[corners == 0], 0)
    np.testing.assert_array_equal(np.unique(colours[corners == 1], axis=0), [[1, 0, 0]])
    # After the last, the colours repeat.
    np.testing.assert_array_equal(colours[corners == 3][0], colours[corners == 1][0])


def test_a_changed_colour_shows_at_once_in_view_list_and_materials(preferences, analyzed):
    bpy.ops.eigenparts.write_outputs(outputs={"CORNER_COLORS", "MATERIALS"})
    preferences.color_2 = (0.25, 0.5, 0.75)
    corners, colours = corners_with_colours(analyzed)
    np.testing.assert_array_equal(np.unique(colours[corners == 2], axis=0), [[0.25, 0.5, 0.75]])
    row = next(row for row in analyzed.data.eigenparts.rows if row.part == 2)
    assert tuple(row.color) == (0.25, 0.5, 0.75)
    assert tuple(analyzed.data.materials[row.title].diffuse_color) == (0.25, 0.5, 0.75, 1)
    # What has a colour of its own keeps it.
    row.color = (0, 1, 0)
    preferences.color_2 = (1, 1, 1)
    assert set(map(tuple, corners_with_colours(analyzed)[1][corners == 2])) == {(0, 1, 0)}


def test_a_changed_colour_stays_through_undo_and_is_taken_back_by_reset(preferences, analyzed):
    standard = corners_with_colours(analyzed)[1]
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="analyzed")
        preferences.body = (0.5, 0.25, 0)
        analyzed.data.eigenparts.level = 1
        bpy.ops.ed.undo_push(message="level 1")
        bpy.ops.ed.undo()
    corners, colours = corners_with_colours(bpy.data.objects["star"])
    assert set(map(tuple, colours[corners == 0])) == {(0.5, 0.25, 0)}
    bpy.ops.eigenparts.reset_colors()
    np.testing.assert_array_equal(corners_with_colours(bpy.data.objects["star"])[1], standard)


def test_only_meshes_of_ours_that_can_be_written_to_are_recoloured(preferences, analyzed):
    other = analyzed.data.copy()
    del other["eigenparts_state"]
    colours = values_of(other, "part_color", 4, np.float32, "color")
    bpy.ops.object.mode_set(mode="EDIT")
    preferences.color_2 = (0.25, 0.5, 0.75)
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(values_of(other, "part_color", 4, np.float32, "color"), colours)
    np.testing.assert_array_equal(corners_with_colours(analyzed)[1], colours[:, :3])


def test_threads_reach_the_library_of_scipy(extension):
    from eigenparts.tasks import threads

    asked = [
        getattr(library, name)
        for library in threads._libraries()
        for name in (
            "scipy_openblas_get_num_threads",
            "scipy_openblas_get_num_threads64_",
            "openblas_get_num_threads64_",
        )
        if hasattr(library, name)
    ]
    if not asked:
        pytest.skip("numpy and scipy have no OpenBLAS of their own here.")
    before = asked[-1]()
    assert threads.use_threads(1) >= 1
    assert [ctypes.c_int(ask()).value for ask in asked] == [1] * len(asked)
    threads.use_threads(before)


@pytest.mark.parametrize("path", OF_ANALYSIS, ids=lambda path: path.stem)
def test_a_preset_sets_every_option_but_the_name_of_an_attribute(extension, path):
    settings = bpy.context.scene.eigenparts
    given = {line.split(" = ")[0].removeprefix("settings.") for line in path.read_text().splitlines()[3:]}
    assert given == set(extension.operators.parts.analysis_options.AnalysisOptions.__annotations__) - {"attribute"}
    settings.order = "2"
    exec(compile(path.read_text(), path.name, "exec"), {})
    assert settings.order != "2"


@pytest.mark.parametrize("path", OF_TRANSFER, ids=lambda path: path.stem)
def test_a_preset_sets_every_option_of_transferring(extension, path):
    options = set(extension.operators.transfer.transfer.TransferOptions.__annotations__)
    settings = bpy.context.scene.eigenparts_transfer
    given = {line.split(" = ")[0].removeprefix("settings.") for line in path.read_text().splitlines()[3:]}
    assert given == options
    settings.layers, settings.factor = {"PARTS"}, 0.5
    exec(compile(path.read_text(), path.name, "exec"), {})
    assert (settings.factor, "PARTS" in settings.layers) == (1, False)


def test_a_preset_of_ones_own_brings_back_what_was_set(extension, tmp_path, monkeypatch):
    monkeypatch.setattr(bpy.utils, "user_resource", lambda kind, *, path, create: str(tmp_path))
    settings = bpy.context.scene.eigenparts_transfer
    settings.layers, settings.mask, settings.mirrored = {"UVS", "COLORS"}, "face", True
    bpy.ops.eigenparts.add_transfer_preset(name="Mine")
    (kept,) = tmp_path.rglob("*.py")
    settings.layers, settings.mask, settings.mirrored = {"GROUPS"}, "", False
    exec(compile(kept.read_text(), kept.name, "exec"), {})
    assert (settings.layers, settings.mask, settings.mirrored) == ({"UVS", "COLORS"}, "face", True)


def test_every_entry_of_the_menu_is_an_action(extension):
    names = [entry[0].removeprefix("eigenparts.") for entry in extension.ui.menus.ENTRIES if entry is not None]
    assert len(names) == len(set(names)) > 10
    assert set(names) <= set(dir(bpy.ops.eigenparts))


class Listener:
    """Stands for an operator that reports."""

    def __init__(self):
        self.heard = []

    def report(self, kind, text):
        self.heard.append((kind, text))


def test_an_error_that_nobody_foresaw_becomes_a_sentence(extension):
    from eigenparts.operators.messages import unexpected_errors

    listener = Listener()
    with unexpected_errors.errors_told(listener):
        raise MemoryError
    assert listener.heard == [({"ERROR"}, unexpected_errors.OUT_OF_MEMORY)]
    with unexpected_errors.errors_told(listener):
        raise ZeroDivisionError("in /home/somebody")
    assert "ZeroDivisionError" in unexpected_errors.last().sentence
    assert "somebody" not in unexpected_errors.last().report
    unexpected_errors.forget()


def test_a_refusal_is_no_fault(extension):
    from eigenparts.operators.messages import unexpected_errors
    from eigenparts.tasks.refusals import Refusal

    listener = Listener()
    with unexpected_errors.errors_told(listener):
        raise Refusal("Select a mesh object first.")
    assert listener.heard == [({"ERROR"}, "Select a mesh object first.")]
    assert unexpected_errors.last() is None
