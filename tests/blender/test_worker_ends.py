"""Whatever ends a worker costs one job: the scene stays as it was, and the next job finds a worker."""

import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

from tests.blender import worker_tasks as tasks
from tests.blender.failing import all_of
from tests.blender.test_background import ended, wait_for
from tests.blender.test_preferences import Listener

ROOT = Path(__file__).parents[2]
PLACES = 20
# Blender with a job, or a worker at rest; says the numbers of the worker and its folder.
BLENDER = """
import sys, time
from functools import partial
from tools.extension import load_extension
extension = load_extension()
import bpy
extension.register()
from eigenparts.operators.jobs import job, worker_process
from tests.blender import worker_tasks as tasks
first = job.Job(partial(tasks.answer, 1))
while not first.look():
    time.sleep(0.01)
if sys.argv[1]:
    second = job.Job(partial(tasks.solve_for_long, sys.argv[1]))
worker = worker_process.running_worker()
print(worker.process.pid, worker.folder, flush=True)
time.sleep(600)
"""


@pytest.fixture
def jobs(extension):
    from eigenparts.operators.jobs import job

    return job


@pytest.fixture
def analyze(extension, star_object):
    """The work of Analyze on the star, and what writes its result."""
    from eigenparts.operators.parts import mesh_segmentation
    from eigenparts.operators.parts.analysis_settings import SETTINGS, AnalysisSettings
    from eigenparts.tasks import mesh_analysis

    settings = AnalysisSettings(**{name: getattr(bpy.context.scene.eigenparts, name) for name in SETTINGS})
    return partial(mesh_analysis.analyze, mesh_segmentation.read(bpy.context, star_object, settings))


def told_by(running):
    """Return what the user is told of a job that has ended."""
    from eigenparts.operators.messages.unexpected_errors import errors_told

    listener = Listener()
    with errors_told(listener):
        running.result()
    return [sentence for _, sentence in listener.heard]


def test_a_worker_that_is_killed_anywhere_is_a_sentence_and_there_again(jobs, analyze, star_object):
    n_reports = ended(jobs.Job(partial(tasks.end_at_report, 0, analyze))).result()
    assert n_reports >= PLACES
    before = all_of(star_object.data)
    for place in range(PLACES):
        running = jobs.Job(partial(tasks.end_at_report, 1 + place * n_reports // PLACES, analyze))
        assert told_by(ended(running)) == [jobs.ENDED]
        assert all_of(star_object.data) == before
    assert ended(jobs.Job(analyze)).result().stored is not None


def test_a_crash_in_a_library_is_a_sentence(jobs):
    assert told_by(ended(jobs.Job(tasks.end_with_a_crash))) == [jobs.ENDED]


def test_a_worker_that_is_killed_at_rest_costs_nothing(jobs):
    ended(jobs.Job(partial(tasks.answer, 1)))
    process = jobs.worker_process.running_worker().process
    process.kill()
    process.wait()
    assert ended(jobs.Job(partial(tasks.answer, 2))).result() == 2


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits of memory are Linux's here")
def test_a_full_memory_is_a_sentence_and_the_worker_goes_on(jobs, analyze):
    from eigenparts.operators.messages.unexpected_errors import OUT_OF_MEMORY

    work = partial(tasks.with_memory_for, 2**27, partial(tasks.take_memory, 2**28))
    assert told_by(ended(jobs.Job(work))) == [OUT_OF_MEMORY]
    assert ended(jobs.Job(analyze)).result().stored is not None


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits of memory are Linux's here")
def test_an_analysis_with_hardly_any_memory_ends_in_a_sentence(jobs, analyze, star_object):
    """Whether the engine notices, or a library beneath it ends the process."""
    before, told = all_of(star_object.data), []
    for n_bytes in (0, 2**20, 2**22, 2**23, 2**24):
        told += told_by(ended(jobs.Job(partial(tasks.with_memory_for, n_bytes, analyze))))
        assert all_of(star_object.data) == before
    assert len(told) >= 1
    assert told
    assert [sentence for sentence in told if "memory" not in sentence.lower()] == []


def test_analyses_outlive_the_worker(jobs, analyze):
    from eigenparts.tasks import recent_analyses

    keeping = partial(analyze, analysis_of=recent_analyses.analyze_and_keep)
    ended(jobs.Job(partial(tasks.end_at_report, 0, keeping)))
    running = jobs.Job(tasks.sleep_for_ever)
    wait_for(lambda: running.look() or running.text == "Half way")
    running.cancel()
    # No report is made where nothing is computed.
    recalling = partial(analyze, analysis_of=recent_analyses.recall)
    assert ended(jobs.Job(partial(tasks.end_at_report, 0, recalling))).result() == 0


def test_a_worker_ends_after_a_rest(jobs, monkeypatch):
    ended(jobs.Job(partial(tasks.answer, 1)))
    process = jobs.worker_process.running_worker().process
    assert jobs.worker_process._end_after_rest() == jobs.worker_process.LOOK
    monkeypatch.setattr(jobs.worker_process, "REST", 0)
    assert jobs.worker_process._end_after_rest() is None
    assert process.returncode is not None


def test_work_that_takes_longer_than_a_rest_goes_on(jobs, monkeypatch):
    running = jobs.Job(tasks.sleep_for_ever)
    wait_for(lambda: running.look() or running.text == "Half way")
    monkeypatch.setattr(jobs.worker_process, "REST", 0)
    assert jobs.worker_process._end_after_rest() == jobs.worker_process.LOOK
    assert not running.look()


def test_disabling_the_extension_leaves_no_process_and_no_folder(jobs, extension):
    ended(jobs.Job(partial(tasks.answer, 1)))
    worker = jobs.worker_process.running_worker()
    extension.unregister()
    assert worker.process.returncode is not None
    assert not worker.folder.exists()
    extension.register()


@pytest.mark.skipif(sys.platform == "win32", reason="a worker there removes its folder itself")
def test_the_folder_of_a_blender_that_was_killed_goes_when_the_next_one_works(jobs, tmp_path, monkeypatch):
    with subprocess.Popen([sys.executable, "-c", ""]) as ended_process:
        pass
    left, others = tmp_path / f"eigenparts-{ended_process.pid}-abc", tmp_path / f"eigenparts-{os.getpid()}-abc"
    foreign = [tmp_path / name for name in ("eigenparts-notes-2", f"blender-{ended_process.pid}-abc")]
    for folder in (left, others, *foreign):
        (folder / "recent").mkdir(parents=True)
    jobs.worker_process.end_session()
    monkeypatch.setattr(jobs.worker_process.tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(
        jobs.worker_process, "bpy", SimpleNamespace(app=SimpleNamespace(tempdir="", timers=bpy.app.timers))
    )
    folder = jobs.worker_process._session_folder()
    assert folder.parent == tmp_path
    assert not left.exists()
    assert all(path.exists() for path in (others, *foreign))
    jobs.worker_process.end_session()
    assert not folder.exists()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks into /proc")
@pytest.mark.parametrize("works", [False, True], ids=["at rest", "at work"])
def test_a_worker_ends_with_a_blender_that_is_killed(tmp_path, works):
    started = tmp_path / "started"
    command = [sys.executable, "-c", BLENDER, str(started) if works else ""]
    with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as blender:
        pid, folder = next(line for line in blender.stdout if "eigenparts-" in line).split(maxsplit=1)
        wait_for(lambda: started.exists() or not works)
        assert is_running(int(pid))
        os.kill(blender.pid, signal.SIGKILL)
    wait_for(lambda: not is_running(int(pid)))
    if not works:
        assert not Path(folder.strip()).exists()


def is_running(pid):
    """Whether a process has not ended, whoever has to take leave of it."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False
