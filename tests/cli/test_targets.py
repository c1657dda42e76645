"""What lies at the place of a result is replaced only if it is known to be ours, and of the same input."""

import json
import os
import shutil
from dataclasses import replace

import pytest

from tests.cli.writing import cli, run_job, save_as_text


@pytest.fixture
def job(tmp_path, monkeypatch):
    """A job whose exporter writes two small texts."""
    monkeypatch.setattr(cli("formats"), "save", save_as_text)
    (tmp_path / "star.obj").write_text("the source")
    return cli("jobs").Job(tmp_path / "star.obj", tmp_path / "star_parts.obj")


def texts_in(folder):
    return {path.name: path.read_text() for path in folder.iterdir() if path.is_file()}


def beside(job):
    return job.target.with_name(job.target.name + ".json")


def test_our_own_result_is_replaced_together_with_what_belongs_to_it(job, tmp_path):
    run_job(job, 1)
    job.path.write_text("another content of the same source")
    assert "error" not in run_job(job, 2)
    texts = texts_in(tmp_path)
    assert sorted(texts) == ["star.obj", "star_parts.mtl", "star_parts.obj", "star_parts.obj.json"]
    assert (texts["star_parts.obj"], texts["star_parts.mtl"]) == ("2", "2")
    assert json.loads(texts["star_parts.obj.json"])["written"].keys() == {"source", "files"}


@pytest.mark.parametrize("name", ["star_parts.obj", "star_parts.mtl", "star_parts.obj.json"])
def test_a_file_of_the_user_stays_until_it_may_be_overwritten(job, tmp_path, name, monkeypatch):
    (tmp_path / name).write_text("days of work")
    before = texts_in(tmp_path)
    with monkeypatch.context() as patch:
        # The first of the work.
        patch.setattr(cli("run_serial"), "digest_of", pytest.fail)
        report = run_job(job, 1)
    assert str(tmp_path / name) in report["error"]
    assert "--output" in report["error"]
    assert "--overwrite" in report["error"]
    assert texts_in(tmp_path) == before
    assert "error" not in run_job(replace(job, overwrite=True), 1)
    assert "error" not in run_job(job, 2)


def test_a_users_file_that_was_overwritten_and_brought_back_is_the_users(job, tmp_path):
    job.target.write_text("days of work")
    run_job(replace(job, overwrite=True), 1)
    job.target.write_text("days of work")
    assert "error" in run_job(job, 2)
    assert job.target.read_text() == "days of work"


@pytest.mark.parametrize("name", ["star_parts.obj", "star_parts.mtl"])
@pytest.mark.parametrize("text", ["", "x", "1.0"])
def test_a_result_that_was_changed_is_neither_finished_nor_replaced(job, tmp_path, name, text):
    run_job(job, 1)
    (tmp_path / name).write_text(text)
    assert cli("results.resume").finished_report(job, {"level": 1}) is None
    assert f"{tmp_path / name} is changed since it was written" in run_job(job, 1)["error"]
    assert (tmp_path / name).read_text() == text
    assert "error" not in run_job(replace(job, overwrite=True), 1)
    assert cli("results.resume").finished_report(job, {"level": 1})


@pytest.mark.parametrize("name", ["star_parts.obj", "star_parts.mtl"])
def test_a_result_that_is_gone_is_made_anew(job, tmp_path, name):
    run_job(job, 1)
    (tmp_path / name).unlink()
    assert cli("results.resume").finished_report(job, {"level": 1}) is None
    assert "error" not in run_job(job, 1)
    assert (tmp_path / name).read_text() == "1"


def test_the_result_of_another_file_stays(job, tmp_path):
    run_job(job, 1)
    other = tmp_path / "elsewhere" / "star.obj"
    other.parent.mkdir()
    other.write_text("another")
    report = run_job(replace(job, path=other), 2)
    assert "the result of another file, star.obj" in report["error"]
    assert job.target.read_text() == "1"


def test_a_source_is_the_same_under_any_name_and_moves_with_its_result(job, tmp_path):
    run_job(job, 1)
    (tmp_path / "link.obj").symlink_to(job.path)
    assert "error" not in run_job(replace(job, path=tmp_path / "link.obj"), 2)
    (tmp_path / "moved").mkdir()
    for name in ("star.obj", "star_parts.obj", "star_parts.mtl", "star_parts.obj.json"):
        (tmp_path / name).rename(tmp_path / "moved" / name)
    moved = cli("jobs").Job(tmp_path / "moved" / "star.obj", tmp_path / "moved" / "star_parts.obj")
    assert cli("results.resume").finished_report(moved, {"level": 2})
    assert "error" not in run_job(moved, 1)


def test_a_link_to_a_result_is_none(job, tmp_path):
    run_job(job, 1)
    job.target.rename(tmp_path / "kept")
    job.target.symlink_to(tmp_path / "kept")
    assert "changed" in run_job(job, 2)["error"]
    assert "error" not in run_job(replace(job, overwrite=True), 2)
    assert (tmp_path / "kept").read_text() == "1"


@pytest.mark.parametrize("name", ["star_parts.obj", "star_parts.mtl", "star_parts.obj.json"])
def test_a_folder_is_never_replaced(job, tmp_path, name):
    (tmp_path / name).mkdir()
    for overwrite in (False, True):
        assert "is a folder" in run_job(replace(job, overwrite=overwrite), 1)["error"]
    assert sorted(os.listdir(tmp_path)) == sorted(["star.obj", name])


def test_what_a_version_without_digests_wrote_is_told(job, tmp_path):
    run_job(job, 1)
    old = json.loads(beside(job).read_text())
    del old["written"]
    beside(job).write_text(json.dumps(old))
    assert cli("results.resume").finished_report(job, {"level": 1}) is None
    assert "a version that did not keep what it wrote" in run_job(job, 1)["error"]
    assert "error" not in run_job(replace(job, overwrite=True), 1)


def test_beside_a_damaged_report_only_the_same_result_is_right(job, tmp_path):
    run_job(job, 1)
    beside(job).write_text("[" * 200_000)
    before = texts_in(tmp_path)
    assert "is no report" in run_job(job, 1)["warnings"][0]
    assert "may be yours" in run_job(job, 2)["error"]
    assert texts_in(tmp_path) == before


def test_what_came_while_the_work_was_done_stays(job, tmp_path, monkeypatch):
    def save_slowly(path, file):
        save_as_text(path, file)
        (tmp_path / "star_parts.mtl").write_text("days of work")

    monkeypatch.setattr(cli("formats"), "save", save_slowly)
    assert "star_parts.mtl is not known" in run_job(job, 1)["error"]
    assert texts_in(tmp_path) == {"star.obj": "the source", "star_parts.mtl": "days of work"}


def test_names_may_be_as_long_as_the_system_takes(job, tmp_path):
    """Its report has the longest name of a result."""
    for length, fits in ((240, True), (241, False), (250, False)):
        name = "n" * length
        shutil.copy(job.path, tmp_path / f"{name}.obj")
        report = run_job(cli("jobs").Job(tmp_path / f"{name}.obj", tmp_path / f"{name}_parts.obj"), 1)
        assert ("error" not in report) == fits
        assert fits or f"shorten the name of the file by {length - 240} bytes" in report["error"]
        assert (f"{name}_parts.obj.json" in os.listdir(tmp_path)) == fits


def test_an_exporter_that_writes_nothing_is_told(job, tmp_path, monkeypatch):
    monkeypatch.setattr(cli("formats"), "save", lambda path, file: path.with_name("other").touch())
    assert "no result" in run_job(job, 1)["error"]
    assert os.listdir(tmp_path) == ["star.obj"]
