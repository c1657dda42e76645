"""A file is there as a whole or not at all."""

from importlib import import_module

import pytest

from tools.extension import load_extension


@pytest.fixture(scope="module")
def atomic_write():
    load_extension()
    return import_module("eigenparts.cli.atomic_write")


def texts_in(folder):
    return {path.name: path.read_text() for path in folder.iterdir() if path.is_file()}


def test_what_is_written_beside_a_file_comes_with_it(atomic_write, tmp_path):
    with atomic_write.staged(tmp_path / "star.obj") as stage:
        stage.write_text("faces")
        stage.with_name("star.mtl").write_text("colours")
        assert texts_in(tmp_path) == {}
    assert texts_in(tmp_path) == {"star.obj": "faces", "star.mtl": "colours"}
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_whatever_happens_meanwhile_the_old_file_stays(atomic_write, tmp_path, error):
    (tmp_path / "star.obj").write_text("old")

    def write_half():
        with atomic_write.staged(tmp_path / "star.obj") as stage:
            stage.write_text("half of the fac")
            raise error

    with pytest.raises(error):
        write_half()
    assert texts_in(tmp_path) == {"star.obj": "old"}
    assert len(list(tmp_path.iterdir())) == 1


def test_the_file_itself_comes_last(atomic_write, tmp_path, monkeypatch):
    """Whoever sees a file finds what belongs to it, so a process that is killed between the two leaves no lone one."""
    order = []
    replace = atomic_write.os.replace
    monkeypatch.setattr(atomic_write.os, "replace", lambda part, goal: (order.append(goal.name), replace(part, goal)))
    with atomic_write.staged(tmp_path / "a.obj") as stage:
        for name in ("a.obj", "z.mtl", "A.png"):
            stage.with_name(name).touch()
    assert order[-1] == "a.obj"
    assert len(order) == 3


def test_what_a_killed_process_left_is_no_part_of_the_next_result(atomic_write, tmp_path):
    with atomic_write.staged(tmp_path / "star.obj") as stage:
        left = stage.parent
        stage.touch()
    left.mkdir()
    (left / "left.mtl").touch()
    with atomic_write.staged(tmp_path / "star.obj") as stage:
        stage.write_text("new")
    assert texts_in(tmp_path) == {"star.obj": "new"}
    assert not left.exists()
