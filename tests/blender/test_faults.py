"""Whatever fails while meshes are written, they keep what they had; whatever ends a job, nothing is written."""

import threading
from contextlib import suppress

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, everything_on, values_of
from tests.blender.drawn import draw_panels
from tests.blender.test_background import wait_for

STATE = "eigenparts_state"


def all_of(mesh):
    """Return everything on a mesh with the values in our state, and its faces."""
    rows = [(row.part, row.share, row.n_faces) for row in mesh.eigenparts.rows]
    state = repr(plain(mesh[STATE])) if STATE in mesh else None
    corners = values_of(mesh, ".corner_vert").tobytes()
    positions = values_of(mesh, "position", 3, np.float32, "vector").tobytes()
    return everything_on(mesh), rows, state, corners, positions, groups_of(mesh), materials_of(mesh)


def groups_of(mesh):
    """Return the weights of each vertex group, by its name."""
    obj = next(obj for obj in bpy.data.objects if obj.data == mesh)
    names = {group.index: group.name for group in obj.vertex_groups}
    weights = {name: {} for name in names.values()}
    for vertex in mesh.vertices:
        for element in vertex.groups:
            weights[names[element.group]][vertex.index] = round(element.weight, 6)
    return weights


def materials_of(mesh):
    """Return the names and colours of the slots, and of the material of each face."""
    slots = [(slot.name, tuple(slot.diffuse_color)) if slot else None for slot in mesh.materials]
    return slots, [polygon.material_index for polygon in mesh.polygons]


def object_as_it_is(obj):
    """Return where an object hangs, what modifies it, and its shape keys."""
    keys = obj.data.shape_keys.key_blocks if obj.data.shape_keys else ()
    shapes = {key.name: np.array([point.co for point in key.data]).tobytes() for key in keys}
    where = tuple(map(tuple, obj.matrix_world)), obj.parent, [modifier.name for modifier in obj.modifiers]
    return where, shapes, [layer.name for layer in obj.data.uv_layers]


def blocks():
    """Return the names of all objects and of what they could be made of."""
    kinds = ("objects", "meshes", "armatures", "curves", "collections", "materials")
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in kinds}


def fails_at_every_call(monkeypatch, writer, call, unchanged, error=MemoryError):
    """Let each call of a writer fail in turn, and look each time; return how many there were."""
    for n in range(1, 1000):
        with monkeypatch.context() as patch:
            failing = fail_at(patch, writer, n, error)
            with suppress(RuntimeError):
                call()
            if failing.n_calls < n:
                return n - 1
        unchanged()
    raise AssertionError("it never ended")


def plain(value):
    if hasattr(value, "to_dict"):
        return {name: plain(value[name]) for name in sorted(value.keys())}
    return list(value) if hasattr(value, "typecode") else value


class Failing:
    """A function that raises when it is called for the n-th time, and counts."""

    def __init__(self, function, n, error=MemoryError):
        self.function, self.n, self.error, self.n_calls = function, n, error, 0

    def __call__(self, *arguments, **options):
        self.n_calls += 1
        if self.n_calls == self.n:
            raise self.error
        return self.function(*arguments, **options)


WRITERS = (
    *("state.write_attribute", "state.packed", "state.packed_array", "state.remove_own_attributes"),
    *("results.write_attribute", "vertex_map.write_attribute", "corner_colours.write_attribute"),
    *("part_table.number_parts", "results._list_parts", "function_hints.store"),
)


def fail_at(monkeypatch, name, n, error=MemoryError):
    """Let the n-th call of a function of the operators fail, and return it."""
    import eigenparts.operators as operators

    module, function = name.split(".")
    owner = getattr(operators, module)
    failing = Failing(getattr(owner, function), n, error)
    monkeypatch.setattr(owner, function, failing)
    return failing


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


@pytest.mark.parametrize("writer", ["state.write_attribute", "results.write_attribute", "registering.match_of"])
def test_a_registration_is_written_to_all_meshes_or_to_none(star, monkeypatch, writer):
    objects = [add_object((1 + k) * star.vertices, star.triangles, f"star {k}") for k in range(3)]
    before = [all_of(obj.data) for obj in objects]
    for n in (1, 2):
        with monkeypatch.context() as patch:
            fail_at(patch, writer, n, ZeroDivisionError)
            with pytest.raises(RuntimeError):
                bpy.ops.eigenparts.register_selected(order="1")
        assert [all_of(obj.data) for obj in objects] == before


@pytest.mark.parametrize("step", ["state.store_branches", "results.segment_mesh", "exchange.read_mesh"])
def test_a_cut_that_fails_leaves_the_faces(analyzed, monkeypatch, step):
    import eigenparts.operators as operators

    before = all_of(analyzed.data)
    owner = operators.cut if step == "exchange.read_mesh" else getattr(operators, step.split(".")[0])
    name = step.split(".")[1]
    monkeypatch.setattr(owner, name, Failing(getattr(owner, name), 1))
    with pytest.raises(RuntimeError):
        bpy.ops.eigenparts.cut()
    assert all_of(analyzed.data) == before


def test_a_cut_that_fails_leaves_weights_keys_and_maps(analyzed, monkeypatch):
    analyzed.vertex_groups.new(name="mine").add([0, 1, 2], 0.5, "REPLACE")
    analyzed.shape_key_add(name="Basis")
    analyzed.shape_key_add(name="wide").data[5].co.x += 1
    analyzed.data.uv_layers.new(name="map").uv[7].vector = 0.25, 0.75
    before = all_of(analyzed.data), object_as_it_is(analyzed), values_of(analyzed.data, "map", 2, np.float32, "vector")
    fail_at(monkeypatch, "state.store_branches", 1)
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
def full(analyzed):
    """The star with all outputs, and a group, a material and an assignment of the user's."""
    mesh = analyzed.data
    analyzed.vertex_groups.new(name="mine").add([0, 1, 2], 0.5, "REPLACE")
    for name in ("skin", "nails"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.arange(len(mesh.polygons)) % 2)
    bpy.ops.eigenparts.write_outputs(outputs=ALL_OUTPUTS, softness=0.05)
    mesh.eigenparts.rows[1].title = "Arm"
    bpy.ops.eigenparts.split_part(part=3, position=0.4)
    return analyzed


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
    *("results.write_attribute", "results._list_parts", "part_table.number_parts", "state.packed"),
    *("corrections.write_attribute", "corrections.packed", "corrections.remove_own_attributes"),
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
    from eigenparts.operators.rollback import all_or_nothing

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
    full.shape_key_add(name="wide").data[5].co.x += 1
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
    *("layer_writing.fill_group", "layer_writing.store_values", "layer_writing._write_key", "layer_writing._slot"),
    *("layer_writing._write_materials", "layer_writing._write_parts", "layer_writing._new_attribute"),
    *("layer_writing._write_attribute", "exchange.write_attribute", "corner_colours.write_attribute"),
)


@pytest.fixture
def found_once(extension, monkeypatch):
    """A transfer finds only once what it writes again and again."""
    from eigenparts.operators import transfer

    monkeypatch.setattr(transfer, "_transfer", cache_of_one(transfer._transfer))


def cache_of_one(function):
    kept = []
    return lambda *arguments: (kept or kept.append(function(*arguments)) or kept)[0]


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
        *("part_sides.remember", "bone_layout.remember", "create_armature.add_armature", "create_armature._add_bones"),
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


def test_a_cancel_at_any_step_of_progress_changes_nothing(analyzed, monkeypatch):
    """Through the operator: each report of progress in turn is where the user cancels."""
    from eigenparts.operators import background, engine

    before, n_steps = all_of(analyzed.data), 0
    while True:
        report = Failing(lambda fraction, text: None, n_steps + 1, engine.Cancelled)
        monkeypatch.setattr(background, "_silent", report)
        with suppress(RuntimeError):
            bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=2, order="1")
        if report.n_calls <= n_steps:
            break
        assert all_of(analyzed.data) == before
        n_steps += 1
    assert n_steps > 5


@pytest.mark.parametrize("operator", ["create_armature", "register_selected", "transfer"])
def test_a_cancelled_longer_job_changes_nothing(analyzed, star, monkeypatch, operator):
    from eigenparts.operators import background, engine

    other = add_object(1.1 * star.vertices, star.triangles, "other")
    other.vertex_groups.new(name="group").add([0, 1], 1.0, "REPLACE")
    bpy.context.view_layer.objects.active = other if operator == "transfer" else analyzed
    before, names = [all_of(obj.data) for obj in (analyzed, other)], set(bpy.data.objects.keys())
    for n in (1, 2):
        report = Failing(lambda fraction, text: None, n, engine.Cancelled)
        monkeypatch.setattr(background, "_silent", report)
        options = {} if operator == "transfer" else {"order": "1"}
        with pytest.raises(RuntimeError):
            getattr(bpy.ops.eigenparts, operator)(**options)
        assert report.n_calls >= n
        assert [all_of(obj.data) for obj in (analyzed, other)] == before
    assert set(bpy.data.objects.keys()) == names


def test_out_of_memory_in_the_engine_changes_nothing(analyzed, monkeypatch):
    from eigenparts.compute import analysis

    before = all_of(analyzed.data)
    with monkeypatch.context() as patch:
        patch.setattr(analysis, "analyze", Failing(analysis.analyze, 1))
        with pytest.raises(RuntimeError):
            bpy.ops.eigenparts.analyze(order="1")
    assert all_of(analyzed.data) == before


def test_a_job_ends_with_the_file_it_was_started_in(extension, star_object):
    """Loading a file makes Blender call ``cancel``; the thread stops at its next report."""
    from eigenparts.operators import background

    go_on, started, reached = threading.Event(), threading.Event(), []

    def work(progress):
        started.set()
        go_on.wait(10)
        progress(0.5, "Half way")
        reached.append("the end")

    job = background._start(work)
    started.wait(10)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    background.stop_running_job()
    go_on.set()
    wait_for(lambda: job.is_done)
    assert (reached, background.is_running()) == ([], False)


def test_a_result_for_a_file_that_is_gone_is_dropped(star_object, extension):
    from eigenparts.operators import exchange, refusals
    from eigenparts.operators.analyze import Ticket, find_mesh

    ticket = Ticket(star_object.data.session_uid, exchange.fingerprint(star_object.data))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with pytest.raises(refusals.Refusal, match="deleted"):
        find_mesh(ticket)


def test_the_thread_of_a_job_does_not_keep_blender_open(extension):
    from eigenparts.operators import job

    go_on = threading.Event()
    running = job.Job(lambda progress: go_on.wait(10))
    assert all(thread.daemon for thread in threading.enumerate() if thread.name == "eigenparts")
    go_on.set()
    wait_for(lambda: running.is_done)


def test_disabling_the_extension_stops_the_job(extension, star_object):
    from eigenparts.operators import background

    go_on = threading.Event()
    job = background._start(lambda progress: go_on.wait(10))
    extension.unregister()
    assert job.is_cancelled
    go_on.set()
    extension.register()
    assert not background.is_running()
