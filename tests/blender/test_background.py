"""Jobs: progress, an end at once when cancelled, and never two at once."""

import sys
import time
from functools import partial

import bpy
import numpy as np
import pytest

from tests.blender import worker_tasks as tasks


@pytest.fixture
def job(extension):
    from eigenparts.operators.jobs import job

    return job


def wait_for(condition, seconds=300):
    for _ in range(int(seconds / 0.01)):
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError("it never happened")


def ended(running):
    """Wait for a job as a timer would, and return it."""
    wait_for(running.look)
    return running


def test_a_job_tells_how_far_it_is_and_gives_its_result(job, tmp_path):
    running = job.Job(partial(tasks.wait_for_file, tmp_path / "go"))
    wait_for(lambda: running.look() or running.text == "Half way")
    assert (running.fraction, running.look()) == (0.5, False)
    (tmp_path / "go").touch()
    assert ended(running).result() == 42
    assert not running.is_in_blender


def test_an_error_of_the_work_is_raised_where_the_result_is_taken(job):
    from eigenparts.operators.messages import unexpected_errors

    with pytest.raises(ZeroDivisionError) as raised:
        ended(job.Job(tasks.divide_by_zero)).result()
    # The bug report says where it happened in the other process.
    assert "in divide_by_zero" in unexpected_errors.traceback_without_folders(raised.value)


def test_an_error_that_cannot_be_sent_is_told_by_its_name(job):
    with pytest.raises(RuntimeError, match="StubbornError"):
        ended(job.Job(tasks.fail_stubbornly)).result()


def test_a_refusal_is_the_same_on_both_sides(job, extension):
    from eigenparts.tasks.refusals import Refusal

    work = partial(tasks.answer, Refusal("Select a mesh object first."))
    assert type(ended(job.Job(work)).result()) is Refusal


def test_the_second_job_finds_the_worker_warm(job):
    from eigenparts.operators.jobs import worker_process

    ended(job.Job(partial(tasks.answer, 1)))
    first = worker_process.running_worker()
    ended(job.Job(partial(tasks.answer, 2)))
    assert worker_process.running_worker() is first


def test_large_arrays_travel_in_files_and_come_back_writable(job):
    from eigenparts.operators.jobs import worker_process
    from eigenparts.tasks import parcels

    given = [np.arange(parcels.LARGE // 8 + 1.0), np.arange(5)]
    for array in ended(job.Job(partial(tasks.add_one, given))).result():
        np.testing.assert_array_equal(array, np.arange(len(array)) + 1)
        array[:] = 0
    assert list(worker_process.running_worker().folder.glob("array-*")) == []


def test_a_worker_finds_modules_where_blender_does(job):
    assert ended(job.Job(tasks.path_of_imports)).result() == sys.path


def test_a_cancelled_job_ends_in_the_middle_of_a_call_and_the_next_one_starts(job, tmp_path):
    running = job.Job(partial(tasks.solve_for_long, tmp_path / "started"))
    wait_for(lambda: running.look() or (tmp_path / "started").exists())
    process = running._worker.process
    running.cancel()
    assert process.returncode is not None
    assert ended(job.Job(partial(tasks.answer, "second"))).result() == "second"


def test_where_no_process_starts_blender_does_the_work(job, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    running = job.Job(partial(tasks.answer, 42))
    assert running.look()
    assert (running.is_in_blender, running.result()) == (True, 42)


def test_where_the_process_ends_before_it_is_ready_blender_does_the_work(job, monkeypatch, tmp_path):
    from eigenparts.tasks import processes

    (tmp_path / "start.py").write_text("raise SystemExit(1)")
    monkeypatch.setattr(processes, "START_FILE", tmp_path / "start.py")
    running = ended(job.Job(partial(tasks.answer, 42)))
    assert (running.is_in_blender, running.result()) == (True, 42)


def test_analyze_is_refused_while_a_job_runs(extension, star_object):
    from eigenparts.operators.jobs import background

    background._start(tasks.sleep_for_ever)
    with pytest.raises(RuntimeError, match="Another job is running"):
        bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.cancel()
    assert bpy.ops.eigenparts.analyze() == {"FINISHED"}
