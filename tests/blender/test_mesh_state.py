"""What a mesh remembers: opened in one file, read once for each action, and nothing damaged gets through."""

import re
from pathlib import Path

import bpy
import numpy as np
import pytest

from tests.blender.damage import HUGE, STATE, damage

ROOT = Path(__file__).parents[2]


def state_of(obj):
    from eigenparts.operators.mesh_state.state import read

    return read(obj.data)


def test_the_state_on_a_mesh_is_opened_in_one_file():
    paths = [
        path for folder in ("operators", "ui", "cli", "tasks", "compute") for path in (ROOT / folder).rglob("*.py")
    ]
    opening = [path.name for path in paths if re.search(rf"\bSTATE\b|{STATE}", path.read_text())]
    assert opening == ["state.py"]


DAMAGED, NEWER = "analyze it again", "newer version"
# What is asked for, where the damage is, and the sentence; each place is damaged in every way that is named.
REFUSED = [
    ("summary", ("schema",), ("gone", "text", "no group"), DAMAGED),
    ("summary", ("schema",), ("huge",), NEWER),
    ("summary", ("description",), ("gone", "zero", "group"), DAMAGED),
    ("summary", ("level",), ("gone", "negative", "huge", "text"), DAMAGED),
    ("summary", ("hierarchy", "n_levels"), ("gone", "zero", "text"), DAMAGED),
    ("summary", ("parts",), ("gone", "zero", "flat group"), DAMAGED),
    ("summary", ("parts", "id", "values"), ("gone", "all negative", "all huge", "cut short"), DAMAGED),
    ("summary", ("parts", "area", "values"), ("all zero", "no numbers", "all infinite", "one negative"), DAMAGED),
    ("summary", ("parts", "n_triangles", "values"), ("all negative", "too long"), DAMAGED),
    ("analysis", ("fingerprint",), ("gone", "text"), "changed after it was analyzed"),
    ("analysis", ("tree_0",), ("gone", "text", "no group"), DAMAGED),
    ("analysis", ("tree_0", "parent", "values"), ("all zero", "cut short", "all huge", "no numbers"), DAMAGED),
    ("analysis", ("tree_0", "n_features"), ("gone", "negative", "nan", "text"), DAMAGED),
    ("analysis", ("tree_0", "closing_length", "values"), ("all huge", "all negative", "cut short"), DAMAGED),
    ("analysis", ("hierarchy", "pairs", "shape"), ("gone", "all huge", "texts"), DAMAGED),
    ("analysis", ("branches_0", "arc", "values"), ("one huge", "one negative", "texts"), DAMAGED),
    ("analysis", ("branches_0", "area", "dtype"), ("text", "zero"), DAMAGED),
    ("analysis", ("closing_heights_0", "values"), ("gone", "cut short", "no numbers"), DAMAGED),
    ("border_source", ("n_inside_edge",), ("gone", "text", "nan"), DAMAGED),
]


@pytest.mark.parametrize(
    ("value", "place", "kind", "sentence"),
    [(value, place, kind, sentence) for value, place, kinds, sentence in REFUSED for kind in kinds],
)
def test_a_damaged_value_is_refused_in_a_sentence(analyzed, extension, value, place, kind, sentence):
    getattr(state_of(analyzed), value)
    damage(analyzed.data, (STATE, *place), kind)
    with pytest.raises(extension.operators.messages.user_errors.Refusal, match=sentence):
        getattr(state_of(analyzed), value)


# What is asked for, where it stands, values that make no sense, and what is read in their place.
REPLACED = [
    ("mode", "mode", (7, "other", "", [1, 2]), "jointed"),
    ("shells", "shells", (7, "other", {}), "bridged"),
    ("outputs", "outputs", (7, [1.5], {"a": 1}), None),
    ("softness", "softness", ("wide", -3.0, [1, 2]), 0.0),
    ("corrections", "corrections", (7, "text", {"0": 7}, {"0": {"kind": "other"}}, {"x": {}}), ()),
    ("function_hints", "function_hints", (7, "text", [1, 2], [0.5, 1.5, 2.5]), []),
    ("part_sides", "part_sides", (7, {"1": 7, "x": [1, 1], "2": [1, 0], "3": [1]}), {}),
    ("bone_layout", "bone_layout", (7, "no JSON", "[]", '{"parts": [-1], "root": [], "limbs": []}'), None),
    ("registration", "registration", (7, "text", [1, 2]), None),
    ("match", "registration", ({"confidence": 0.5}, {"order": [1], "signs": [3]}), None),
]


@pytest.mark.parametrize(
    ("value", "name", "stored", "expected"),
    [(value, name, stored, expected) for value, name, damages, expected in REPLACED for stored in damages],
)
def test_a_damaged_choice_counts_as_none(analyzed, value, name, stored, expected):
    analyzed.data[STATE][name] = stored
    assert getattr(state_of(analyzed), value) == expected


@pytest.mark.parametrize("stored", [7, "text", {"x": [1, 2]}, {"1": HUGE}, {"1": [0.5]}, {"1": {"0": 1}}])
@pytest.mark.parametrize("table", ["part_numbers", "part_names", "part_colours"])
def test_rows_of_tables_that_make_no_sense_are_passed_over(analyzed, table, stored):
    analyzed.data[STATE][table] = stored
    parts = state_of(analyzed).parts
    assert {"part_numbers": parts.places, "part_names": parts.names, "part_colours": parts.colours}[table] == {}


def test_a_mesh_without_an_analysis_remembers_nothing(star_object, extension):
    state = state_of(star_object)
    assert not state.is_readable
    assert (state.corrections, state.match, state.outputs, state.softness) == ((), None, None, 0.0)
    with pytest.raises(extension.operators.messages.user_errors.Refusal, match="Analyze the mesh first"):
        _ = state.analysis


def test_the_level_is_read_without_trees_and_tables(analyzed):
    state = state_of(analyzed)
    assert 0 < state.shown_level <= state.highest_level
    assert state.n_parts == len(analyzed.data.eigenparts.rows)
    assert not {"analysis", "analysis_of_any_shape", "parts", "corrections"} & set(vars(state))


def test_a_value_is_decoded_once(analyzed, monkeypatch, extension):
    state = state_of(analyzed)
    assert state.analysis is state.analysis
    monkeypatch.setattr(extension.operators.mesh_state.state, "unpacked_summary", None)
    assert state_of(analyzed).mode == "jointed"


@pytest.fixture
def readings(extension, monkeypatch):
    """The meshes that were read, in this order."""
    kind, meshes = extension.operators.mesh_state.state.MeshState, []
    make = kind.__init__

    def count_and_make(self, mesh, stored):
        meshes.append(mesh.name)
        make(self, mesh, stored)

    monkeypatch.setattr(kind, "__init__", count_and_make)
    return meshes


ACTIONS = {
    "segment": lambda mesh: bpy.ops.eigenparts.segment(level=2),
    "level": lambda mesh: setattr(mesh.eigenparts, "level", 2),
    "number": lambda mesh: setattr(mesh.eigenparts, "n_parts", 3),
    "mode": lambda mesh: setattr(mesh.eigenparts, "mode", "FEATURES"),
    "outputs": lambda mesh: bpy.ops.eigenparts.write_outputs(outputs={"FACE_SETS", "MATERIALS"}, softness=0.1),
    "one output": lambda mesh: setattr(mesh.eigenparts, "face_sets", True),
    "softness": lambda mesh: setattr(mesh.eigenparts, "softness", 0.2),
    "name": lambda mesh: setattr(mesh.eigenparts.rows[1], "title", "Arm"),
    "colour": lambda mesh: setattr(mesh.eigenparts.rows[1], "color", (0.1, 0.2, 0.3)),
    "merge": lambda mesh: bpy.ops.eigenparts.merge_parts(part=1, into=0),
    "split": lambda mesh: bpy.ops.eigenparts.split_part(part=1, position=0.4),
    "border": lambda mesh: bpy.ops.eigenparts.move_border(part=1, offset=-0.05),
    "branch": lambda mesh: bpy.ops.eigenparts.set_branch_level(part=1, level=1),
    "corrections": lambda mesh: bpy.ops.eigenparts.clear_corrections(),
    "clear": lambda mesh: bpy.ops.eigenparts.clear(),
}


@pytest.mark.parametrize("action", ACTIONS)
def test_an_action_reads_the_mesh_once(analyzed, readings, action):
    ACTIONS[action](analyzed.data)
    assert readings == [analyzed.data.name]
    assert bpy.context.window_manager.eigenparts.problem == ""


def test_redrawn_branches_are_stored_again_where_they_were_lost(analyzed):
    bpy.ops.eigenparts.split_part(part=1, position=0.4)
    part_tree, corrections = state_of(analyzed).redrawn
    del analyzed.data[STATE]["pieces"]
    assert state_of(analyzed).redrawn is None
    bpy.ops.eigenparts.segment(level=4)
    again, corrected = state_of(analyzed).redrawn
    np.testing.assert_array_equal(again.branches[0].of_face, part_tree.branches[0].of_face)
    np.testing.assert_array_equal(corrected.side, corrections.side)


def test_an_edited_mesh_still_says_what_it_shows(analyzed):
    before = state_of(analyzed).summary
    analyzed.data.vertices[7].co.x += 0.01
    assert state_of(analyzed).summary == before
    assert state_of(analyzed).analysis_of_any_shape.part_tree.hierarchy.n_levels == before.n_levels
