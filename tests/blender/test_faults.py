"""Whatever fails while meshes are written, they keep what they had."""

from contextlib import suppress

import bpy
import numpy as np
import pytest

from tests import shapes
from tests.blender.conftest import add_object, analyzed_star, values_of
from tests.blender.drawn import draw_panels
from tests.blender.failing import (
    all_of,
    blocks,
    fail_at,
    fails_at_every_call,
    groups_of,
    object_as_it_is,
)


@pytest.fixture(scope="module")
def star():
    """A small one: everything is done to it again and again."""
    return shapes.star(n_arms=5, n_subdivisions=2)


WRITERS = (
    *("mesh_arrays.write_attribute", "stored_analysis.packed", "stored_analysis.packed_array"),
    "mesh_arrays.remove_own_attributes",
    *("division_writer.write_attributes", "vertex_map.write_attribute", "corner_colours.write_attribute"),
    *("division_writer.number_parts", "division_writer.list_parts", "function_hints.packed_hints"),
)


@pytest.mark.parametrize("writer", WRITERS)
@pytest.mark.parametrize("is_analyzed", [False, True])
def test_out_of_memory_while_an_analysis_is_written_changes_nothing(star_object, monkeypatch, writer, is_analyzed):
    if is_analyzed:
        bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=2, order="1")
        bpy.ops.eigenparts.segment(level=1)
    before = all_of(star_object.data)
    n_meshes, n = len(bpy.data.meshes), 1
    while True:
        with monkeypatch.context() as patch:
            failing = fail_at(patch, writer, n)
            with suppress(RuntimeError):
                bpy.ops.eigenparts.analyze(order="1")
            if failing.n_calls < n:
                break
        assert all_of(star_object.data) == before
        n += 1
    assert n > 1
    assert len(bpy.data.meshes) == n_meshes
    assert all_of(star_object.data) != before


@pytest.mark.parametrize(
    "writer", ["mesh_arrays.write_attribute", "division_writer.write_attributes", "mesh_registration.match_of"]
)
def test_a_registration_is_written_to_all_meshes_or_to_none(star, monkeypatch, writer):
    objects = [add_object((1 + k) * star.vertices, star.triangles, f"star {k}") for k in range(3)]
    before = [all_of(obj.data) for obj in objects]
    for n in (1, 2):
        with monkeypatch.context() as patch:
            fail_at(patch, writer, n, ZeroDivisionError)
            with pytest.raises(RuntimeError):
                bpy.ops.eigenparts.register_selected(order="1")
        assert [all_of(obj.data) for obj in objects] == before


@pytest.mark.parametrize(
    "step", ["analysis_writer.store_branches", "part_writer.segment_mesh", "analyzed_faces.read_mesh"]
)
def test_a_cut_that_fails_leaves_the_faces(analyzed, monkeypatch, step):
    before = all_of(analyzed.data)
    fail_at(monkeypatch, step, 1)
    with pytest.raises(RuntimeError):
        bpy.ops.eigenparts.cut()
    assert all_of(analyzed.data) == before


def test_a_cut_that_fails_leaves_weights_keys_and_maps(analyzed, monkeypatch):
    analyzed.vertex_groups.new(name="mine").add([0, 1, 2], 0.5, "REPLACE")
    analyzed.shape_key_add(name="Basis")
    analyzed.shape_key_add(name="wide").data[5].co.x += 1
    analyzed.data.uv_layers.new(name="map").uv[7].vector = 0.25, 0.75
    before = all_of(analyzed.data), object_as_it_is(analyzed), values_of(analyzed.data, "map", 2, np.float32, "vector")
    fail_at(monkeypatch, "analysis_writer.store_branches", 1)
    with pytest.raises(RuntimeError):
        bpy.ops.eigenparts.cut()
    after = all_of(analyzed.data), object_as_it_is(analyzed), values_of(analyzed.data, "map", 2, np.float32, "vector")
    assert after[:2] == before[:2]
    np.testing.assert_array_equal(after[2], before[2])


def test_a_name_and_a_colour_that_cannot_be_written_are_not_taken(full, monkeypatch):
    before, row = all_of(full.data), full.data.eigenparts.rows[2]
    for writer in ("vertex_groups._fill_softly", "material_slots._assign", "corner_colours.write_attribute"):
        with monkeypatch.context() as patch:
            fail_at(patch, writer, 1)
            row.title = "Leg"
        with monkeypatch.context() as patch:
            fail_at(patch, writer, 1)
            row.color = 1, 0, 1
        assert all_of(full.data) == before
    row.title = "Leg"
    assert "Leg" in groups_of(full.data)


@pytest.fixture
def full(scene, star):
    """The star with all outputs, and a group, a material and an assignment of the user's."""
    return scene(full_star, star)


def full_star(star):
    analyzed_star(star)
    obj = bpy.context.object
    mesh = obj.data
    obj.vertex_groups.new(name="mine").add([0, 1, 2], 0.5, "REPLACE")
    for name in ("skin", "nails"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.arange(len(mesh.polygons)) % 2)
    bpy.ops.eigenparts.write_outputs(outputs=ALL_OUTPUTS, softness=0.05)
    mesh.eigenparts.rows[1].title = "Arm"
    bpy.ops.eigenparts.split_part(part=3, position=0.4)


ALL_OUTPUTS = {"VERTEX_ATTRIBUTE", "CORNER_COLORS", "FACE_SETS", "VERTEX_GROUPS", "MATERIALS", "FIELD"}
CHANGES = {
    "level": lambda: bpy.ops.eigenparts.segment(level=2),
    "mode": lambda: bpy.ops.eigenparts.segment(level=2, mode="FEATURES"),
    "split": lambda: bpy.ops.eigenparts.split_part(part=1, position=0.3),
    "border": lambda: bpy.ops.eigenparts.move_border(part=2, offset=0.05),
    "corrections": lambda: bpy.ops.eigenparts.clear_corrections(),
    "outputs": lambda: bpy.ops.eigenparts.write_outputs(outputs={"FACE_SETS"}),
    "analysis": lambda: bpy.ops.eigenparts.analyze(order="1"),
    "clearing": lambda: bpy.ops.eigenparts.clear(),
}
# Everything that is written with, down to what hands groups and materials over to Blender.
LEVEL_WRITERS = (
    *("division_writer.write_attributes", "division_writer.list_parts", "division_writer.number_parts"),
    *("division_writer.packed", "division_writer.remember"),
    *("mesh_arrays.write_attribute", "corrections.packed_branches", "mesh_arrays.remove_own_attributes"),
    *("vertex_map.write_attribute", "corner_colours.write_attribute", "face_sets.write_attribute"),
    *("field_values.write_attribute", "vertex_groups._groups", "vertex_groups._fill_softly", "vertex_groups._drop"),
    *("material_slots._slot", "material_slots._dress", "material_slots._assign", "material_slots._drop_slots"),
)


@pytest.mark.parametrize("change", CHANGES)
def test_a_change_that_fails_anywhere_leaves_everything_as_it_was(full, monkeypatch, change):
    before, names, n_failed = all_of(full.data), blocks(), 0
    for writer in LEVEL_WRITERS:
        for n in range(1, 1 + n_calls(monkeypatch, writer, full.data, CHANGES[change])):
            with monkeypatch.context() as patch:
                fail_at(patch, writer, n)
                with pytest.raises(RuntimeError):
                    CHANGES[change]()
            assert all_of(full.data) == before, (writer, n)
            assert blocks() == names
            n_failed += 1
    assert n_failed > 2
    draw_panels()


def n_calls(monkeypatch, writer, mesh, change):
    """Return how often a change calls a writer if nothing fails; it is taken back."""
    from eigenparts.operators.outputs.rollback import all_or_nothing

    with monkeypatch.context() as patch:
        counting = fail_at(patch, writer, 0)
        with suppress(ZeroDivisionError), all_or_nothing(mesh):
            change()
            n = counting.n_calls
            raise ZeroDivisionError
    return n


def test_after_a_change_that_fails_the_next_one_works(full, monkeypatch):
    with monkeypatch.context() as patch:
        fail_at(patch, "vertex_groups._fill_softly", 1)
        with pytest.raises(RuntimeError):
            bpy.ops.eigenparts.segment(level=1)
    assert bpy.ops.eigenparts.segment(level=1) == {"FINISHED"}
    assert set(groups_of(full.data)) == {"mine", *(row.title for row in full.data.eigenparts.rows)}


def test_the_panel_tells_of_a_level_that_found_no_memory(full, monkeypatch):
    before = all_of(full.data)
    with monkeypatch.context() as patch:
        fail_at(patch, "corner_colours.write_attribute", 1)
        full.data.eigenparts.level = 1
    assert all_of(full.data) == before
    assert "not enough memory" in bpy.context.window_manager.eigenparts.problem


@pytest.fixture
def dressed(full, star):
    """Two stars beside the full one that have some of its layers, and some of their own."""
    full.shape_key_add(name="Basis")
    wide = full.shape_key_add(name="wide")
    wide.data[5].co.x += 1
    wide.driver_add("value").driver.variables.new()
    full.data.uv_layers.new(name="map")
    full.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", star.vertices[:, 0].astype(np.float32))
    others = [add_object((1 + k) * star.vertices, star.triangles, f"star {k}") for k in (1, 2)]
    for other in others:
        other.shape_key_add(name="Basis")
    others[0].vertex_groups.new(name="mine").add([3, 4], 0.25, "REPLACE")
    others[0].data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", np.ones(len(star.vertices)))
    others[1].shape_key_add(name="wide").data[7].co.z += 1
    others[1].data.materials.append(bpy.data.materials["skin"])
    bpy.context.view_layer.objects.active = full
    return others


TRANSFER_WRITERS = (
    *("layer_writing.fill_group", "layer_writing.store_values", "layer_writing._slot"),
    *("shape_keys._write_places", "shape_keys._new_key", "drivers._write_curve", "drivers.write_settings"),
    *("layer_writing._write_materials", "layer_writing._write_parts", "layer_writing._new_attribute"),
    *("layer_writing._write_attribute", "mesh_arrays.write_attribute", "corner_colours.write_attribute"),
)


@pytest.fixture
def found_once(extension, monkeypatch):
    """A transfer finds only once what it writes again and again."""
    from eigenparts.operators.transfer import transfer

    monkeypatch.setattr(transfer, "map_to_all", cache_of_one(transfer.map_to_all))


def cache_of_one(function):
    kept = []
    return lambda *arguments, **options: (kept or kept.append(function(*arguments, **options)) or kept)[0]


@pytest.mark.parametrize("writer", TRANSFER_WRITERS)
def test_a_transfer_is_written_to_all_objects_or_to_none(dressed, found_once, monkeypatch, writer):
    before, names = [(all_of(obj.data), object_as_it_is(obj)) for obj in dressed], blocks()

    def unchanged():
        assert [(all_of(obj.data), object_as_it_is(obj)) for obj in dressed] == before
        assert blocks() == names

    layers = {"GROUPS", "SHAPE_KEYS", "UVS", "COLORS", "ATTRIBUTES", "FACES", "MATERIALS", "PARTS"}
    call = lambda: bpy.ops.eigenparts.transfer(layers=layers)  # noqa: E731
    assert fails_at_every_call(monkeypatch, writer, call, unchanged, ZeroDivisionError) >= 1
    assert [(all_of(obj.data), object_as_it_is(obj)) for obj in dressed] != before


MAKERS = {
    "create_armature": (
        *(
            "part_sides.packed_sides",
            "bone_layout.packed_layout",
            "create_armature.add_armature",
            "create_armature._add_bones",
        ),
        *("create_armature._colour_bones", "create_armature.bind"),
    ),
    "create_skeleton_curves": ("create_skeleton_curves.add_curve",),
    "separate": ("separate._mesh_of_part", "separate._copy", "separate._forget_analysis"),
    "trace_complex": ("trace_complex.add_object", "trace_complex.curve_of", "trace_complex.dots_of"),
}


@pytest.mark.parametrize(("operator", "step"), [(name, step) for name, steps in MAKERS.items() for step in steps])
def test_what_makes_objects_makes_all_or_none(full, monkeypatch, operator, step):
    state = lambda: (all_of(full.data), object_as_it_is(full), blocks(), bpy.context.mode)  # noqa: E731
    before, options = state(), {} if operator == "separate" else {"order": "1"}

    def unchanged():
        assert state() == before
        assert bpy.context.view_layer.objects.active == full
        assert bpy.context.selected_objects == [full]

    n_failed = fails_at_every_call(
        monkeypatch, step, lambda: getattr(bpy.ops.eigenparts, operator)(**options), unchanged
    )
    assert n_failed >= 1
    assert state() != before


def test_a_mesh_that_blender_fails_to_bind_stays_unbound(full, monkeypatch):
    """Automatic weights are given by Blender's own operator, which leaves a parent and a modifier."""
    before = all_of(full.data), object_as_it_is(full), blocks()
    fail_at(monkeypatch, "create_armature._is_bound", 1)
    with pytest.raises(RuntimeError):
        bpy.ops.eigenparts.create_armature(order="1", weights="AUTOMATIC")
    assert (all_of(full.data), object_as_it_is(full), blocks()) == before
