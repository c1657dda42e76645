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
    return everything_on(mesh), rows, state, corners, positions


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


@pytest.mark.parametrize("writer", ["corrections.write_attribute", "corrections.packed", "results.write_attribute"])
def test_after_a_correction_that_fails_the_mesh_still_works(analyzed, monkeypatch, writer):
    labels = values_of(analyzed.data, "part")
    with monkeypatch.context() as patch:
        fail_at(patch, writer, 1)
        with pytest.raises(RuntimeError):
            bpy.ops.eigenparts.split_part(part=1, position=0.3)
    draw_panels()
    bpy.ops.eigenparts.clear_corrections()
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), labels)
    assert bpy.ops.eigenparts.split_part(part=1, position=0.3) == {"FINISHED"}


@pytest.mark.parametrize("writer", ["results.write_attribute", "corner_colours.write_attribute", "results._list_parts"])
def test_after_a_level_that_fails_the_next_one_works(analyzed, monkeypatch, writer):
    labels = values_of(analyzed.data, "part")
    level = analyzed.data.eigenparts.level
    with monkeypatch.context() as patch:
        fail_at(patch, writer, 1)
        with pytest.raises(RuntimeError):
            bpy.ops.eigenparts.segment(level=1)
    draw_panels()
    assert bpy.ops.eigenparts.segment(level=level) == {"FINISHED"}
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), labels)


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
