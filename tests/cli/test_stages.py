"""Stages: where a result is written until it is whole."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.writing import cli, line_of

# Holds a stage in a folder until it is told to end.
HOLDER = """
import sys
from pathlib import Path
from tests.cli.writing import cli
with cli("results.stages").stage_in(Path(sys.argv[1])) as stage:
    (stage / "half").touch()
    print("stage:", stage.name, flush=True)
    sys.stdin.read()
"""


@pytest.fixture(scope="module")
def stages():
    return cli("results.stages")


@pytest.fixture
def other_run(tmp_path):
    """Another process that writes into the folder; yields it and its stage."""
    command = [sys.executable, "-c", HOLDER, str(tmp_path)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, cwd=Path(__file__).parents[2], **pipes) as process:
        yield process, tmp_path / line_of(process, "stage: ")
        process.kill()


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_a_stage_leaves_nothing(stages, tmp_path, error):
    def write_half():
        with stages.stage_in(tmp_path) as stage:
            (stage / "star.obj").write_text("half of the fac")
            assert len(names_in(tmp_path)) == 1
            raise error

    with pytest.raises(error):
        write_half()
    assert names_in(tmp_path) == []


def test_a_stage_is_hidden_and_short_whatever_the_name_of_the_result(stages, tmp_path):
    with stages.stage_in(tmp_path) as stage, stages.stage_in(tmp_path) as other:
        assert stage != other
        assert stage.name.startswith(".")
        assert len(stage.name) < 32
        assert stages.files_in(stage) == []


def test_the_stage_of_a_process_at_work_stays_and_that_of_one_that_was_killed_goes(stages, other_run):
    process, stage = other_run
    stages.remove_stale(stage.parent)
    assert (stage / "half").exists()
    process.kill()
    process.wait()
    stages.remove_stale(stage.parent)
    assert names_in(stage.parent) == []


def test_a_stage_without_a_word_in_it_goes_and_the_folders_of_the_user_stay(stages, tmp_path):
    """A process may be killed before it marks its stage; names of stages are no names that anybody thinks of."""
    with stages.stage_in(tmp_path) as stage:
        pass
    stage.mkdir()
    mine = [
        tmp_path / ".eigenparts-empty",
        tmp_path / ".eigenparts-star_parts.off",
        tmp_path / ".eigenparts-0123456789abcdef",
    ]
    for folder in mine:
        folder.mkdir()
    (mine[1] / "notes").touch()
    (tmp_path / ".eigenparts-link").symlink_to(mine[1])
    stages.remove_stale(tmp_path)
    assert names_in(tmp_path) == sorted([*(folder.name for folder in mine), ".eigenparts-link"])
    assert names_in(mine[1]) == ["notes"]


def test_a_file_system_without_locks_is_written_to_and_nothing_on_it_counts_as_stale(stages, tmp_path, monkeypatch):
    def lock_nothing(descriptor, operation):
        raise OSError(37, "No locks available")

    monkeypatch.setattr(cli("results.locks").fcntl, "flock", lock_nothing)
    with stages.stage_in(tmp_path) as stage:
        stages.remove_stale(tmp_path)
        assert stage.exists()


def test_a_folder_that_another_run_holds_is_waited_for_and_told_of(tmp_path, monkeypatch):
    locks = cli("results.locks")
    monkeypatch.setattr(locks, "PATIENCE", 0.1)
    with locks.folder_lock(tmp_path), pytest.raises(TimeoutError, match="another run"), locks.folder_lock(tmp_path):
        pass
    with locks.folder_lock(tmp_path), locks.folder_lock(tmp_path / "missing"):
        pass


def test_what_an_exporter_does_not_tell_is_noticed(stages, tmp_path):
    """One of two times it writes less."""
    texts = iter(["all of it", "all of"])
    with stages.stage_in(tmp_path) as stage:
        path = stage / "star.obj"
        with pytest.raises(OSError, match="as a whole"):
            stages.write_surely(lambda: path.write_text(next(texts)), path)
        stages.write_surely(lambda: path.write_text("all of it"), path)
    assert os.listdir(tmp_path) == []
