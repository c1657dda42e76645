"""Work on several meshes is shared among processes: what comes out is the same, and none of them is left behind."""

import subprocess
import sys
from functools import partial

import bpy
import pytest

from tests.blender import worker_tasks as tasks
from tests.blender.conftest import add_object
from tests.blender.test_background import ended, wait_for
from tests.blender.test_worker_ends import ROOT, is_running
from tests.blender.test_worker_results import bits

# Blender with a job that two processes share.
BLENDER = """
import sys, time
from functools import partial
from tools.extension import load_extension
extension = load_extension()
extension.register()
from eigenparts.operators.jobs import job
from tests.blender import worker_tasks as tasks
job.preferred_processes = lambda: 2
running = job.Job(partial(tasks.in_processes, tasks.tell_process_and_sleep, [(path,) for path in sys.argv[1:]]))
while not running.look():
    time.sleep(0.01)
"""


@pytest.fixture
def jobs(extension, monkeypatch):
    """Jobs that two processes share."""
    from eigenparts.operators.jobs import job

    monkeypatch.setattr(job, "preferred_processes", lambda: 2)
    return job


def test_calls_are_shared_and_answered_in_their_order(jobs, tmp_path):
    work = partial(tasks.in_processes, tasks.meet, [(number, str(tmp_path)) for number in range(6)])
    running = ended(jobs.Job(work))
    numbers, processes = zip(*running.result(), strict=True)
    assert numbers == (0, 1, 2, 3, 4, 5)
    assert len(set(processes)) == 2
    assert running._worker.process.pid not in processes


def test_helpers_are_warm_the_next_time(jobs, tmp_path):
    work = partial(tasks.in_processes, tasks.meet, [(number, str(tmp_path)) for number in range(2)])
    first, second = ({process for _, process in ended(jobs.Job(work)).result()} for _ in range(2))
    assert len(first) == 2
    assert first == second


def test_what_a_helper_did_when_it_ended_is_done_by_another(jobs, tmp_path):
    work = partial(tasks.in_processes, tasks.end_the_first_time, [(str(tmp_path / name),) for name in "ab"])
    assert ended(jobs.Job(work)).result() == ["done", "done"]
    assert {path.name for path in tmp_path.iterdir()} == {"a", "b"}


def test_of_several_errors_that_of_the_first_call_is_raised(jobs):
    work = partial(tasks.in_processes, tasks.raise_late, [(0.3, "first"), (0.0, "second")])
    with pytest.raises(ValueError, match="first"):
        ended(jobs.Job(work)).result()


def test_a_cancelled_job_leaves_no_helper(jobs, tmp_path):
    paths = [tmp_path / name for name in "ab"]
    running = jobs.Job(partial(tasks.in_processes, tasks.tell_process_and_sleep, [(str(path),) for path in paths]))
    wait_for(lambda: running.look() or all(path.exists() and path.read_text() for path in paths))
    running.cancel()
    wait_for(lambda: not any(is_running(int(path.read_text())) for path in paths))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
def test_helpers_end_with_a_blender_that_is_killed(tmp_path):
    paths = [tmp_path / name for name in "ab"]
    command = [sys.executable, "-c", BLENDER, *map(str, paths)]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL) as blender:
        wait_for(lambda: all(path.exists() and path.read_text() for path in paths))
        blender.kill()
    wait_for(lambda: not any(is_running(int(path.read_text())) for path in paths))


@pytest.mark.parametrize("operator", ["register_selected", "transfer"])
def test_many_meshes_get_from_several_processes_what_a_script_gives_them(jobs, analyzed, star, monkeypatch, operator):
    from eigenparts.operators.jobs import background

    shared = []

    def execute(self, context):
        work, handle = self.begin(context)
        result = ended(jobs.Job(work)).result()
        shared.append(bits(result) == bits(work(lambda fraction, text: None)))
        return self.finish(context, handle, result)

    analyzed.vertex_groups.new(name="group").add([0, 1], 1.0, "REPLACE")
    for size in (1.1, 1.2):
        add_object(size * star.vertices, star.triangles, f"size {size}").select_set(True)
    analyzed.select_set(True)
    bpy.context.view_layer.objects.active = analyzed
    monkeypatch.setattr(background.BackgroundOperator, "execute", execute)
    assert getattr(bpy.ops.eigenparts, operator)() == {"FINISHED"}
    assert shared == [True]
