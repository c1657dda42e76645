"""Files done in processes of their own, here and on a cluster."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import bpy
import psutil
import pytest

from tests.cli.files import add_object, write_blend, write_off
from tests.shapes import star

# Seconds that are enough for a small star on a machine that is busy.
TIME_LIMIT = 40
LAUNCHER = Path(__file__).parents[2] / "cli" / "launch.py"
# Stands in for the command line: does each file at once, but one of these makes its process end without a word.
STAND_IN = """
import json, os, pathlib, signal, sys, time
for file in sys.argv[sys.argv.index("--") + 1:]:
    once = pathlib.Path(file + ".once")
    if "deadly" in file or "unlucky" in file and not once.exists():
        once.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    if "endless" in file:
        left = pathlib.Path(file).with_name(".eigenparts-" + pathlib.Path(file).stem)
        left.mkdir()
        (left / ".eigenparts-stage").touch()
        time.sleep(600)
    print("Blender says something")
    print(json.dumps({"version": 1, "file": file, "error": "done by the stand-in.", "seconds": 0.0}), flush=True)
"""


@pytest.fixture
def folder(tmp_path):
    """Six stars in two folders."""
    for k in range(6):
        write_off(star(3 + k % 3, 2), tmp_path / "in" / str(k % 2) / f"star{k}.off")
    return tmp_path / "in"


@pytest.fixture
def command_line(tmp_path):
    """The command line in a process of its own."""

    def start(*arguments, **options):
        command = [sys.executable, "-P", LAUNCHER, "", *arguments]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        return subprocess.Popen(list(map(str, command)), cwd=tmp_path, **pipes | options)

    return start


def texts_of(folder):
    return {path.name: path.read_text() for path in folder.rglob("star*_parts.off")}


def reports_in(folder):
    return [path for path in folder.rglob("star*_parts.off.json") if not path.parent.name.startswith(".")]


def test_processes_do_the_same_as_one(run, folder, tmp_path):
    run("batch", folder, "--output", tmp_path / "one")
    code, report, _ = run("batch", folder, "--output", tmp_path / "two", "--jobs", 2, "--json")
    assert code == 0
    assert sorted(file["file"] for file in report["files"]) == sorted(map(str, folder.rglob("*.off")))
    assert texts_of(tmp_path / "one") == texts_of(tmp_path / "two")
    # What processes finished counts as finished for all.
    assert run("batch", folder, "--output", tmp_path / "two")[2] == ["0 of 0 files (6 finished before)"]


def test_processes_register_to_the_same_reference(run, folder):
    files = sorted(folder.rglob("*.off"))[:2]
    _, alone, _ = run("register", *files, "--json")
    code, together, _ = run("register", *files, "--jobs", 2, "--json")
    assert code == 0
    assert parts_of(together) == parts_of(alone)


def parts_of(report):
    return sorted((file["file"], file["objects"][0]["parts"]) for file in report["files"])


@pytest.fixture
def stand_in(run, monkeypatch):
    """Processes that do nothing, and die of some files."""
    run("--help")
    from eigenparts.cli.processes import pool

    monkeypatch.setattr(pool, "own_command", lambda: [sys.executable, "-c", STAND_IN])


def test_a_file_that_kills_its_process_takes_no_other_with_it(run, stand_in, tmp_path):
    names = [f"{kind}{number}.off" for number in range(40) for kind in ("deadly", "good", "unlucky")]
    for name in names:
        (tmp_path / name).touch()
    _, _, errors = run("batch", tmp_path, "--jobs", 3)
    told = dict(line.removeprefix(f"{tmp_path}/").split(": ", 1) for line in errors if ".off: " in line)
    assert sorted(told) == sorted(names)
    deaths = [name for name, problem in told.items() if "ended twice" in problem and "signal 9" in problem]
    assert sorted(deaths) == sorted(name for name in names if name.startswith("deadly"))
    assert all("done by the stand-in" in told[name] for name in names if not name.startswith("deadly"))


def test_a_file_that_takes_too_long_has_failed_and_the_others_go_on(run, stand_in, tmp_path):
    names = ["deadly.off", "endless1.off", "endless2.off", *(f"good{number}.off" for number in range(6))]
    for name in names:
        (tmp_path / name).touch()
    code, _, errors = run("batch", tmp_path, "--jobs", 3, "--timeout", 8)
    told = dict(line.removeprefix(f"{tmp_path}/").split(": ", 1) for line in errors if ".off: " in line)
    assert (code, sorted(told)) == (1, names)
    assert told["endless1.off"] == told["endless2.off"]
    assert told["endless1.off"].startswith("it took longer than 8 seconds; ")
    assert "ended twice" in told["deadly.off"]
    assert all("done by the stand-in" in told[name] for name in names[3:])
    assert not list(tmp_path.glob(".eigenparts-*"))


def test_a_time_limit_needs_processes(run, star_off):
    code, _, errors = run("segment", star_off, "--timeout", 5, "--in-process")
    assert code == 2
    assert "does not go with --in-process" in errors[-1]
    assert run("segment", star_off, "--jobs", 1, "--timeout", 0)[0] == 2


def test_a_command_that_is_not_there_fails_every_file(run, folder, monkeypatch):
    run("--help")
    from eigenparts.cli.processes import pool

    monkeypatch.setattr(pool, "own_command", lambda: ["/there/is/no/blender"])
    code, _, errors = run("batch", folder, "--jobs", 2)
    assert code == 1
    assert sum("no/blender" in line for line in errors) == 6


def test_a_worker_killed_in_the_middle_costs_nothing(command_line, folder):
    batch = command_line("batch", folder, "--jobs", 2)
    victims = wait_for(lambda: psutil.Process(batch.pid).children())
    victims[0].kill()
    out, err = batch.communicate(timeout=200)
    assert batch.returncode == 0, err
    assert out.count(", written to ") == 6
    assert len(texts_of(folder)) == 6
    assert not list(folder.rglob(".eigenparts-*"))


def test_a_worker_that_hangs_is_ended_and_the_others_go_on(command_line, folder):
    """A real one, stopped by the system, so that it never ends by itself."""
    batch = command_line("batch", folder, "--jobs", 2, "--timeout", TIME_LIMIT)
    # The system lets a process wait for a child that is stopped before it has begun with its own program.
    children = psutil.Process(batch.pid).children
    victims = wait_for(lambda: [child for child in children() if "--in-process" in child.cmdline()])
    victims[0].suspend()
    out, err = batch.communicate(timeout=10 * TIME_LIMIT)
    assert batch.returncode == 1
    assert err.count(f"it took longer than {TIME_LIMIT} seconds; ") == 1, err
    assert out.count(", written to ") == len(texts_of(folder)) == 5
    assert not list(folder.rglob(".eigenparts-*"))
    assert not victims[0].is_running()


def test_a_batch_killed_in_the_middle_is_resumed(command_line, folder, tmp_path):
    batch = command_line("batch", folder)
    wait_for(lambda: reports_in(folder))
    batch.kill()
    batch.communicate()
    n_finished = len(reports_in(folder))
    again = command_line("batch", folder)
    out, err = again.communicate(timeout=200)
    assert again.returncode == 0
    assert f"({n_finished} finished before)" in err
    assert out.count(", written to ") == 6 - n_finished
    assert len(texts_of(folder)) == 6


def test_a_process_killed_while_it_writes_leaves_the_old_result_or_the_new_one(run, command_line, tmp_path):
    add_object(star(5, 3))
    source, result = write_blend(tmp_path / "star.blend"), tmp_path / "star_parts.blend"
    run("segment", source)
    known = {source.read_bytes(), result.read_bytes()}
    again = command_line("segment", source, "--level", 2)
    while again.poll() is None and not list(tmp_path.glob(".eigenparts-*")):
        time.sleep(0.001)
    again.kill()
    again.communicate()
    bpy.ops.wm.open_mainfile(filepath=str(result))
    assert bpy.data.objects["star"].data["eigenparts_state"]["level"] in (2, 4)
    assert source.read_bytes() in known
    assert run("segment", source, "--level", 3)[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["star.blend", result.name, result.name + ".json"]


def wait_for(something):
    """Return what appears within a minute or two."""
    for _ in range(1200):
        if found := something():
            return found
        time.sleep(0.1)
    raise AssertionError("it never came")


@pytest.fixture
def cluster(tmp_path):
    """A dask scheduler and two workers; yields its address."""
    pytest.importorskip("distributed", reason="needs dask")
    dask = [sys.executable, "-m", "dask"]
    address_file = tmp_path / "scheduler.json"
    options = ["--no-dashboard", "--scheduler-file", str(address_file)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    scheduler = subprocess.Popen([*dask, "scheduler", "--host", "127.0.0.1", "--port", "0", *options], **quiet)
    workers = [
        subprocess.Popen([*dask, "worker", *options, "--nthreads", "1", "--no-nanny", "--death-timeout", "60"], **quiet)
        for _ in "12"
    ]
    yield address_file, workers
    for process in (*workers, scheduler):
        process.terminate()
        process.wait()


def test_a_cluster_does_the_same_as_one_process(run, command_line, cluster, folder, tmp_path):
    address_file, _ = cluster
    run("batch", folder, "--output", tmp_path / "one")
    batch = command_line("batch", folder, "--output", tmp_path / "many", "--scheduler", address_of(address_file))
    out, err = batch.communicate(timeout=300)
    assert batch.returncode == 0, err
    assert out.count(", written to ") == 6
    assert texts_of(tmp_path / "one") == texts_of(tmp_path / "many")


@pytest.mark.long
def test_a_lost_machine_costs_nothing(command_line, cluster, folder):
    address_file, workers = cluster
    batch = command_line("batch", folder, "--scheduler", address_of(address_file))
    wait_for(lambda: reports_in(folder))
    workers[0].kill()
    _, err = batch.communicate(timeout=300)
    assert batch.returncode == 0, err
    assert len(texts_of(folder)) == 6


def address_of(address_file):
    wait_for(address_file.exists)
    return json.loads(wait_for(address_file.read_text))["address"]


def test_a_scheduler_that_does_not_answer_is_told(run, star_off, monkeypatch, tmp_path):
    run("--help")
    from eigenparts.cli.processes import cluster

    monkeypatch.setattr(cluster, "PATIENCE", 1)
    code, _, errors = run("segment", star_off, "--scheduler", "tcp://127.0.0.1:9", "--output", tmp_path)
    assert (code, errors) == (1, ["no dask scheduler answers at tcp://127.0.0.1:9."])
    assert os.listdir(tmp_path) == []


@pytest.fixture
def crashing(run, monkeypatch):
    """Processes that crash at some files, and say what Blender says when memory runs out at others."""
    run("--help")
    from eigenparts.cli.processes import pool

    monkeypatch.setattr(pool, "own_command", lambda: [sys.executable, "-c", CRASHES])


CRASHES = """
import json, os, signal, sys
for file in sys.argv[sys.argv.index("--") + 1:]:
    if "full" in file:
        print("Malloc returns null: len=99 in mesh, total 5", file=sys.stderr, flush=True)
    if "bad" in file or "full" in file or "after" in file and len(sys.argv) - sys.argv.index("--") > 2:
        open(file, "a").write("tried ")
        os.kill(os.getpid(), signal.SIGSEGV)
    print(json.dumps({"version": 1, "file": file, "error": "done by the stand-in.", "seconds": 0.0}), flush=True)
"""


def test_a_crash_is_told_in_words_after_one_try(run, crashing, tmp_path):
    for name in ("a.off", "bad.off", "c.off", "full.off"):
        (tmp_path / name).touch()
    code, _, errors = run("batch", tmp_path, "--timeout", 60)
    told = dict(line.removeprefix(f"{tmp_path}/").split(": ", 1) for line in errors if ".off: " in line)
    assert code == 1
    assert told["a.off"] == told["c.off"] == "done by the stand-in."
    assert "Blender crashed while working on it (signal 11: " in told["bad.off"]
    assert told["full.off"].startswith("there is not enough memory for this file; ")
    assert (tmp_path / "bad.off").read_text() == "tried "


def test_named_files_share_a_process_until_one_crashes(run, crashing, tmp_path):
    """A file that crashes behind others may be innocent, so it gets a process that had no other before."""
    names = ["a.off", "after.off", "bad.off", "d.off"]
    for name in names:
        (tmp_path / name).touch()
    _, report, _ = run("segment", *(tmp_path / name for name in names), "--json", "--timeout", 60)
    assert [file["file"] for file in report["files"]] == [str(tmp_path / name) for name in names]
    assert ["stand-in" in file["error"] for file in report["files"]] == [True, False, False, True]


def test_a_file_beyond_the_limit_of_memory_has_failed_and_says_so(command_line, tmp_path):
    files = [write_off(star(3, 2), tmp_path / "a.off"), write_off(star(5, 5), tmp_path / "large.off")]
    files.append(write_off(star(4, 2), tmp_path / "z.off"))
    process = command_line("segment", *files, "--memory-limit", "0.03")
    out, err = process.communicate(timeout=300)
    assert (process.returncode, out.count(", written to ")) == (1, 2), err
    assert err.startswith(f"{files[1]}: large: The analysis of 10,242 vertices takes about ")
    assert "of memory, and " in err


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals of this kind")
def test_an_interrupted_batch_leaves_no_process_behind(command_line, folder):
    batch = command_line("batch", folder, "--jobs", 2)
    children = wait_for(lambda: psutil.Process(batch.pid).children())
    batch.send_signal(signal.SIGINT)
    _, err = batch.communicate(timeout=60)
    assert (batch.returncode, "Interrupted" in err) == (1, True)
    assert not any(child.is_running() for child in children)


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux ends the processes of a process that was killed")
def test_a_killed_batch_leaves_no_process_behind(command_line, folder):
    batch = command_line("batch", folder)
    wait_for(lambda: reports_in(folder))
    (child,) = wait_for(lambda: psutil.Process(batch.pid).children())
    time.sleep(3)
    batch.kill()
    batch.communicate()
    wait_for(lambda: not child.is_running())


def test_numbers_of_parts_go_on_behind_a_crash(run, monkeypatch, tmp_path):
    """As in one process, though another one does the files behind the one that crashed."""
    run("--help")
    from eigenparts.cli.processes import pool

    monkeypatch.setattr(pool, "own_command", lambda: [sys.executable, "-c", NUMBERS])
    files = [tmp_path / name for name in ("a.off", "bad.off", "c.off")]
    _, report, _ = run("register", *files, "--json-lines", "--timeout", 60)
    rows = [json.loads(line) for line in report]
    assert [row["objects"][0]["parts"][0]["id"] for row in rows if "objects" in row] == [7, 8]


# Gives the part of each file the first number that is free, 7 if nobody says which.
NUMBERS = """
import json, os, sys
free = [int(word.partition("=")[2]) for word in sys.argv if word.startswith("--first-free=")] or [7]
for file in sys.argv[sys.argv.index("--") + 1:]:
    if "bad" in file:
        os.abort()
    parts = [{"id": free[0], "name": "a", "parent": 0, "area": 1, "faces": 1, "matched": False}]
    objects = [{"name": "a", "parts": parts}]
    print(json.dumps({"version": 1, "file": file, "seconds": 0.0, "objects": objects}), flush=True)
"""
