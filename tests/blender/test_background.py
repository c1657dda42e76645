"""Jobs: progress, an end that is dropped when cancelled, and never two at once."""

import threading

import bpy
import pytest


@pytest.fixture
def job(extension):
    from eigenparts.operators.jobs import job

    return job


def wait_for(condition, seconds=10):
    pause = threading.Event()
    for _ in range(int(seconds / 0.01)):
        if condition():
            return
        pause.wait(0.01)
    raise AssertionError("it never happened")


def test_a_job_tells_how_far_it_is_and_gives_its_result(job):
    go_on = threading.Event()

    def work(progress):
        progress(0.5, "Half way")
        go_on.wait(10)
        return 42

    running = job.Job(work)
    wait_for(lambda: running.text == "Half way")
    assert (running.fraction, running.is_done) == (0.5, False)
    go_on.set()
    wait_for(lambda: running.is_done)
    assert running.result() == 42


def test_an_error_of_the_work_is_raised_where_the_result_is_taken(job):
    running = job.Job(lambda progress: 1 / 0)
    wait_for(lambda: running.is_done)
    with pytest.raises(ZeroDivisionError):
        running.result()


def test_a_cancelled_job_stops_at_its_next_report(job, extension):
    started, go_on = threading.Event(), threading.Event()
    reached = []

    def work(progress):
        started.set()
        go_on.wait(10)
        progress(0.9, "Nearly done")
        reached.append("the end")

    running = job.Job(work)
    started.wait(10)
    running.cancel()
    go_on.set()
    wait_for(lambda: running.is_done)
    assert reached == []
    with pytest.raises(extension.compute.Cancelled):
        running.result()


def test_the_next_job_waits_for_a_cancelled_one(job):
    go_on, started = threading.Event(), threading.Event()
    first = job.Job(lambda progress: (started.set(), go_on.wait(10)))
    started.wait(10)
    first.cancel()
    second = job.Job(lambda progress: "second")
    assert "Waiting" in second.text
    assert not second.is_done
    go_on.set()
    wait_for(lambda: second.is_done)
    assert second.result() == "second"


def test_analyze_is_refused_while_a_job_runs(extension, star_object):
    from eigenparts.operators.jobs import background

    go_on = threading.Event()
    background._start(lambda progress: go_on.wait(10))
    with pytest.raises(RuntimeError, match="Another job is running"):
        bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.cancel()
    go_on.set()
    assert bpy.ops.eigenparts.analyze() == {"FINISHED"}
