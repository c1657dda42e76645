"""Whatever ends a job, nothing is written."""

from contextlib import suppress

import bpy
import pytest

from tests.blender import worker_tasks as tasks
from tests.blender.conftest import add_object
from tests.blender.failing import Failing, all_of


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
    """Loading a file makes Blender call ``cancel``."""
    from eigenparts.operators.jobs import background

    job = background._start(tasks.sleep_for_ever)
    process = job._worker.process
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    background.stop_running_job()
    assert process.returncode is not None
    assert not background.is_running()


def test_a_result_for_a_file_that_is_gone_is_dropped(star_object, extension):
    from eigenparts.operators.jobs.mesh_handle import MeshHandle
    from eigenparts.operators.messages import user_errors

    handle = MeshHandle.of(star_object)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with pytest.raises(user_errors.Refusal, match="deleted"):
        handle.find_mesh()


def test_disabling_the_extension_stops_the_job(extension, star_object):
    from eigenparts.operators.jobs import background

    job = background._start(tasks.sleep_for_ever)
    extension.unregister()
    assert job.is_cancelled
    extension.register()
    assert not background.is_running()
