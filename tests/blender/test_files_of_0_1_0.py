"""A file that was saved with 0.1.0 opens with its parts, names, colours, corrections, registration and outputs.

What it has to show was written down by 0.1.0 itself: see ``data/save_with_0_1_0.py``.
"""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest

from tests.blender.conftest import exact_labels_of, values_of
from tests.blender.drawn import draw_panels

SAVED = Path(__file__).parent / "data" / "parts_of_0_1_0.blend"
SHOWN = json.loads(SAVED.with_suffix(".json").read_text())


@pytest.fixture(scope="module")
def numbers():
    with np.load(SAVED.with_suffix(".npz")) as stored:
        return dict(stored)


@pytest.fixture(autouse=True)
def opened(fresh_scene):
    bpy.ops.wm.open_mainfile(filepath=str(SAVED))


def activated(name):
    obj = bpy.data.objects[name]
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    return obj


def materials_of(obj):
    """Return the name of the material of each face."""
    names = [material.name for material in obj.data.materials]
    return [names[polygon.material_index] for polygon in obj.data.polygons] if names else []


@pytest.mark.parametrize("name", SHOWN)
def test_parts_names_and_colours_are_those_that_were_saved(name, numbers):
    mesh, shown = bpy.data.objects[name].data, SHOWN[name]
    np.testing.assert_array_equal(values_of(mesh, "part"), numbers[f"{name} labels"])
    rows = [(row.part, row.depth, row.title, row.n_faces) for row in mesh.eigenparts.rows]
    assert rows == [(row["part"], row["depth"], row["title"], row["faces"]) for row in shown["rows"]]
    for row, saved in zip(mesh.eigenparts.rows, shown["rows"], strict=True):
        assert list(row.color) == pytest.approx(saved["color"])
    for setting in ("level", "mode", "n_parts"):
        assert getattr(mesh.eigenparts, setting) == shown[setting]


@pytest.mark.parametrize("name", SHOWN)
def test_outputs_are_chosen_and_there(name, numbers):
    obj, shown = bpy.data.objects[name], SHOWN[name]
    chosen = ("corner_colors", "face_sets", "field", "materials", "vertex_attribute", "vertex_groups")
    assert [kind.upper() for kind in chosen if getattr(obj.data.eigenparts, kind)] == shown["outputs"]
    assert obj.data.eigenparts.softness == pytest.approx(shown["softness"])
    assert sorted(group.name for group in obj.vertex_groups) == shown["groups"]
    assert [material.name for material in obj.data.materials] == shown["materials"]
    if shown["materials"]:
        assert materials_of(obj) == [shown["materials"][slot] for slot in numbers[f"{name} slots"]]
    np.testing.assert_array_equal([len(vertex.groups) for vertex in obj.data.vertices], numbers[f"{name} grouped"])


def test_outputs_are_written_again_over_those_of_0_1_0(numbers):
    beast = activated("beast")
    assert bpy.ops.eigenparts.write_outputs(outputs={"FIELD"}) == {"FINISHED"}
    assert [material.name for material in beast.data.materials] == ["Fur"]
    assert len(beast.vertex_groups) == 0
    beast.data.eigenparts.materials = beast.data.eigenparts.vertex_groups = True
    assert sorted(group.name for group in beast.vertex_groups) == SHOWN["beast"]["groups"]
    saved = [SHOWN["beast"]["materials"][slot] for slot in numbers["beast slots"]]
    assert materials_of(beast) == saved


def test_corrections_are_listed_and_each_can_be_taken_back(numbers):
    beast, listed = activated("beast"), SHOWN["beast"]["corrections"]
    rows = [{"title": row.title, "rests": row.rests} for row in beast.data.eigenparts.correction_rows]
    assert rows == listed
    assert len({correction["title"].split()[-2] for correction in listed}) == len(listed) == 5
    for place in reversed(range(len(listed))):
        bpy.ops.eigenparts.remove_correction(index=place)
        np.testing.assert_array_equal(values_of(beast.data, "part"), numbers[f"beast without {place}"])


@pytest.mark.parametrize("name", ["beast", "blobs"])
def test_every_level_divides_as_it_did_and_the_saved_one_comes_back(name, numbers):
    obj = activated(name)
    n_levels = sum(key.startswith(f"{name} level ") for key in numbers)
    for level in range(n_levels):
        bpy.ops.eigenparts.segment(level=level)
        np.testing.assert_array_equal(values_of(obj.data, "part"), numbers[f"{name} level {level}"])
    with pytest.raises(RuntimeError, match="does not exist"):
        bpy.ops.eigenparts.segment(level=n_levels)
    bpy.ops.eigenparts.segment(level=SHOWN[name]["level"])
    np.testing.assert_array_equal(values_of(obj.data, "part"), numbers[f"{name} labels"])
    assert [row.title for row in obj.data.eigenparts.rows] == [row["title"] for row in SHOWN[name]["rows"]]


def test_the_registration_is_known_and_moving_the_level_gives_back_what_is_its_own(numbers):
    runner = activated("runner")
    told = draw_panels()
    assert "Parts of beast" in told
    assert any(text.startswith("runner  ") for text in told)
    bpy.ops.eigenparts.segment(level=SHOWN["runner"]["level"])
    assert [row.title for row in runner.data.eigenparts.rows] == SHOWN["runner"]["own titles"]
    assert "Parts of beast" not in draw_panels()
    level = SHOWN["runner"]["level"]
    np.testing.assert_array_equal(values_of(runner.data, "part"), numbers[f"runner level {level}"])


def test_bones_follow_the_layout_that_was_saved_with_the_reference():
    activated("runner")
    bpy.ops.eigenparts.create_armature(weights="NONE", order="1")
    assert sorted(bone.name for bone in bpy.context.object.data.bones) == SHOWN["runner"]["bones"]


def test_a_new_analysis_keeps_the_corrections_and_names(numbers):
    """Twins that are equally high may change places, so parts may have other numbers, but no face goes elsewhere.

    Borders are shown along edges now, and below that they are where they were.
    """
    beast = activated("beast")
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.segment(level=SHOWN["beast"]["level"])
    assert len(beast.data.eigenparts.correction_rows) == 5
    assert {"Schnauze", "Leg"} <= {row.title for row in beast.data.eigenparts.rows}
    pairs = np.unique(np.stack([exact_labels_of(beast.data), numbers["beast labels"]]), axis=1)
    assert pairs.shape[1] == len(SHOWN["beast"]["rows"]) == beast.data.eigenparts.n_parts
