"""Whatever ends a job, nothing is written."""

import threading
from contextlib import suppress

import bpy
import pytest

from tests.blender.conftest import add_object
from tests.blender.failing import Failing, all_of
from tests.blender.test_background import wait_for


def test_a_cancel_at_any_step_of_progress_changes_nothing(analyzed, monkeypatch):
    """Through the operator: each report of progress in turn is where the user cancels."""
    from eigenparts import compute as engine
    from eigenparts.operators.jobs import background

    before, n_steps = all_of(analyzed.data), 0
    while True:
        report = Failing(lambda fraction, text: None, n_steps + 1, engine.Cancelled)
        monkeypatch.setattr(background, "silent", report)
        with suppress(RuntimeError):
            bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=2, order="1")
        if report.n_calls <= n_steps:
            break
        assert all_of(analyzed.data) == before
        n_steps += 1
    assert n_steps > 5


@pytest.mark.parametrize("operator", ["create_armature", "register_selected", "transfer"])
def test_a_cancelled_longer_job_changes_nothing(analyzed, star, monkeypatch, operator):
    from eigenparts import compute as engine
    from eigenparts.operators.jobs import background

    other = add_object(1.1 * star.vertices, star.triangles, "other")
    other.vertex_groups.new(name="group").add([0, 1], 1.0, "REPLACE")
    bpy.context.view_layer.objects.active = other if operator == "transfer" else analyzed
    before, names = [all_of(obj.data) for obj in (analyzed, other)], set(bpy.data.objects.keys())
    for n in (1, 2):
        report = Failing(lambda fraction, text: None, n, engine.Cancelled)
        monkeypatch.setattr(background, "silent", report)
        options = {} if operator == "transfer" else {"order": "1"}
        with pytest.raises(RuntimeError):
            getattr(bpy.ops.eigenparts, operator)(**options)
        assert report.n_calls >= n
        assert [all_of(obj.data) for obj in (analyzed, other)] == before
    assert set(bpy.data.objects.keys()) == names


def test_out_of_memory_in_the_engine_changes_nothing(analyzed, monkeypatch):
    from eigenparts.compute.analysis import analyze as analysis

    before = all_of(analyzed.data)
    with monkeypatch.context() as patch:
        patch.setattr(analysis, "analyze", Failing(analysis.analyze, 1))
        with pytest.raises(RuntimeError):
            bpy.ops.eigenparts.analyze(order="1")
    assert all_of(analyzed.data) == before


def test_a_job_ends_with_the_file_it_was_started_in(extension, star_object):
    """Loading a file makes Blender call ``cancel``; the thread stops at its next report."""
    from eigenparts.operators.jobs import background

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
    from eigenparts.operators.jobs.mesh_handle import MeshHandle
    from eigenparts.operators.messages import user_errors

    handle = MeshHandle.of(star_object)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with pytest.raises(user_errors.Refusal, match="deleted"):
        handle.find_mesh()


def test_the_thread_of_a_job_does_not_keep_blender_open(extension):
    from eigenparts.operators.jobs import job

    go_on = threading.Event()
    running = job.Job(lambda progress: go_on.wait(10))
    assert all(thread.daemon for thread in threading.enumerate() if thread.name == "eigenparts")
    go_on.set()
    wait_for(lambda: running.is_done)


def test_disabling_the_extension_stops_the_job(extension, star_object):
    from eigenparts.operators.jobs import background

    go_on = threading.Event()
    job = background._start(lambda progress: go_on.wait(10))
    extension.unregister()
    assert job.is_cancelled
    go_on.set()
    extension.register()
    assert not background.is_running()
