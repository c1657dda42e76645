"""Whatever fails while a result is written: what counts as finished is whole, and the next run makes all good."""

import errno
import itertools
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import warnings
from contextlib import contextmanager
from pathlib import Path

import bpy
import pytest

from tests.cli.writing import Calls, cli, line_of, run_job, save_as_text, size_of

OFTEN, SELDOM = [".off", ".obj", ".glb"], [".ply", ".fbx", ".blend"]
SUFFIXES = [*OFTEN, *(pytest.param(suffix, marks=pytest.mark.long) for suffix in SELDOM)]
ROOT = Path(__file__).parents[2]
# Calls that change files while a result with one file takes the place of an older one: stage, marker, result, room,
# twice the report, three moves, and what is removed.
FEWEST_CALLS = 10


@pytest.fixture(scope="module")
def calls():
    return Calls()


@pytest.fixture
def job(tmp_path):
    """A job whose target has the ending that is asked for."""

    def make(suffix):
        source = tmp_path / f"star{suffix}"
        source.write_text("the source")
        return cli("jobs").Job(source, tmp_path / f"star_parts{suffix}")

    return make


def sizes_finished(job):
    """Return the levels for which the result counts as finished, and check that it is the one of that level."""
    finished = [level for level in (1, 2, 3) if cli("results.resume").finished_report(job, {"level": level})]
    for level in finished:
        assert size_in(job.target) == pytest.approx(level, rel=1e-4)
    return finished


def size_in(path):
    """Return the size of the star in a result, however it is written."""
    if path.stat().st_size < 100:
        assert path.with_suffix(".mtl").read_text() == path.read_text()
        return float(path.read_text())
    obj = cli("formats").load(path).objects[0]
    bpy.context.view_layer.update()
    return size_of(obj)


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


def refuse():
    raise OSError(errno.ENOSPC, "No space left on device")


def assert_old_or_new(job, report, folder):
    """After anything that can happen to the run of level 2 there is the old, the new, or what the next run mends."""
    finished = sizes_finished(job)
    assert len(finished) <= 1
    assert "error" in report or finished == [2]
    assert job.path.read_text() == "the source"
    assert "error" not in run_job(job, 3)
    assert sizes_finished(job) == [3]
    assert not any(name.startswith(".") for name in names_in(folder))


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_any_call_may_fail(job, calls, tmp_path, suffix):
    """As SQLite is tested: the first call that changes a file fails, then the second, to the last."""
    job = job(suffix)
    for number in itertools.count(1):
        assert "error" not in run_job(job, 1)
        with calls.at(number, refuse, tmp_path):
            report = run_job(job, 2)
        if calls.n_calls < number:
            break
        assert_old_or_new(job, report, tmp_path)
    assert number > FEWEST_CALLS


# Blender's own exporter of .glb leaves its file open when it fails.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("suffix", OFTEN + SELDOM)
def test_a_file_may_be_cut_short_anywhere(job, tmp_path, suffix):
    """Files can hold so many bytes and no more, which not every exporter tells."""
    job = job(suffix)
    run_job(job, 2)
    size = job.target.stat().st_size
    for limit in (0, 1, size // 2, size - 1):
        assert "error" not in run_job(job, 1)
        report = with_limit(limit, lambda: run_job(job, 2))
        assert "error" in report
        assert sizes_finished(job) == [1]
        assert_old_or_new(job, report, tmp_path)


@pytest.mark.parametrize("suffix", [".obj", ".ply"])
def test_room_that_comes_back_does_not_hide_that_there_was_none(job, tmp_path, suffix, monkeypatch):
    """These exporters go on where they could not write, and tell nobody."""
    job, limits = job(suffix), resource.getrlimit(resource.RLIMIT_FSIZE)
    run_job(job, 1)
    digests_in = cli("results.stages")._digests_in

    def look_with_room(stage):
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        return digests_in(stage)

    monkeypatch.setattr(cli("results.stages"), "_digests_in", look_with_room)
    report = with_limit(job.target.stat().st_size // 2, lambda: run_job(job, 2))
    assert "could not be written as a whole" in report["error"]
    assert_old_or_new(job, report, tmp_path)


def with_limit(n_bytes, work):
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (n_bytes, hard))
    try:
        return work()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_process_may_be_killed_at_any_call(job, calls, tmp_path, monkeypatch):
    monkeypatch.setattr(cli("formats"), "save", save_as_text)
    job = job(".obj")
    codes = []
    while not codes or codes[-1] == signal.SIGKILL:
        assert "error" not in run_job(job, 1)
        codes.append(code_of_process(lambda: killed_at(calls, len(codes) + 1, job, tmp_path)))
        assert_old_or_new(job, {"error": "killed"}, tmp_path)
    assert codes[-1] == 0
    assert len(codes) > FEWEST_CALLS


def killed_at(calls, number, job, folder):
    with calls.at(number, lambda: os.kill(os.getpid(), signal.SIGKILL), folder):
        run_job(job, 2)


def code_of_process(work):
    """Return how a copy of this process ends, which does nothing but this."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        pid = os.fork()
    if pid == 0:
        try:
            work()
            os._exit(0)
        finally:
            os._exit(1)
    return os.waitpid(pid, 0)[1]


def test_a_disk_may_be_full(tmp_path):
    """A real one, of 3 MB, with more and less room on it: the old result stays, and the new one comes when there is."""
    mount = 'mount -t tmpfs -o size=3m tmpfs "$0" && exec "$@"'
    command = ["unshare", "--map-root-user", "--mount", "sh", "-c", mount, tmp_path]
    if not shutil.which("unshare") or subprocess.run([*command, "true"], capture_output=True).returncode:
        pytest.skip("needs a system where a disk can be mounted")
    script = [sys.executable, "-m", "tests.cli.full_disk", tmp_path]
    process = subprocess.run([*command, *script], cwd=ROOT, capture_output=True, text=True, timeout=300)
    rows = [json.loads(line.removeprefix("FULL ")) for line in process.stdout.splitlines() if line.startswith("FULL ")]
    assert len(rows) == 6 * 5, process.stderr
    for suffix, error, finished, again in rows:
        assert again == "", (suffix, again)
        assert finished == ([1] if error else [2]), (suffix, error)
        assert error == "" or error == "No space left on device." or "is there room on the disk?" in error, error
    assert sum(error != "" for _, error, _, _ in rows) >= 20


@contextmanager
def process_at_work(job):
    """Yield a process that writes results of one size and the other in turns."""
    command = [sys.executable, "-m", "tests.cli.write_on", job.path, job.target]
    with subprocess.Popen(list(map(str, command)), cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        line_of(process, "begins")
        yield process
        process.kill()


@pytest.mark.parametrize("moment", [0.1, *(pytest.param(k * 0.013, marks=pytest.mark.long) for k in range(60))])
def test_a_process_may_be_killed_at_any_moment(job, tmp_path, moment):
    """A real one, which does nothing but write, killed by the clock."""
    job = job(".off")
    with process_at_work(job):
        time.sleep(moment)
    assert_old_or_new(job, {"error": "killed"}, tmp_path)


def test_runs_that_write_the_same_result_go_on_side_by_side(job, tmp_path):
    """Whenever nobody is exchanging files, the result is whole and its report is its own."""
    job, seen = job(".off"), set()
    with process_at_work(job) as first, process_at_work(job) as second:
        for n_looks in itertools.count():
            with cli("results.locks").folder_lock(tmp_path):
                (level,) = sizes_finished(job)
            seen.add(level)
            if n_looks >= 20 and len(seen) == 2:
                break
        assert (first.poll(), second.poll()) == (None, None)
    assert_old_or_new(job, {"error": "killed"}, tmp_path)
