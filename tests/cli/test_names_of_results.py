"""Results have names that no other source's result has, and only what would come out the same is not done again."""

import itertools
import json
import os
from importlib import import_module
from pathlib import Path

import pytest

from tools.extension import load_extension

SUFFIXES = (".blend", ".obj", ".ply", ".stl", ".glb", ".gltf", ".fbx", ".off")


@pytest.fixture(scope="module")
def cli():
    load_extension()
    return {
        name.rpartition(".")[2]: import_module(f"eigenparts.cli.{name}")
        for name in ("formats", "jobs", "results.resume", "reports.report", "results.digests", "results.targets")
    }


def test_no_two_sources_of_one_name_have_the_same_result(cli):
    sources = [Path(f"star{suffix}") for suffix in SUFFIXES]
    for name_of in (cli["formats"].name_of_divided, cli["formats"].name_of_transferred):
        names = list(map(name_of, sources))
        assert len(set(names)) == len(names) == len(cli["formats"].FORMATS)
        assert all(Path(name).suffix in SUFFIXES for name in names)
    assert cli["formats"].name_of_divided(Path("star.off")) == "star_parts.off"
    assert cli["formats"].name_of_divided(Path("star.stl")) == "star_stl_parts.blend"


def test_results_go_beside_their_files_or_into_one_folder(cli):
    jobs_of_files, files = cli["jobs"].jobs_of_files, [Path("a/star.off"), Path("b/star.off"), Path("a/star.off")]
    beside = jobs_of_files(files, None, lambda path: f"new_{path.name}")
    assert [job.target for job in beside] == [Path("a/new_star.off"), Path("b/new_star.off")]
    assert cli["jobs"].refused_jobs(beside, files) == {}
    together = jobs_of_files(files, Path("out"), lambda path: path.name)
    assert list(cli["jobs"].refused_jobs(together, files)) == [together[1]]
    assert "that of a/star.off" in cli["jobs"].refused_jobs(together, files)[together[1]]


def test_a_source_is_never_a_target_whatever_its_name(cli, tmp_path):
    source = tmp_path / "star.off"
    source.touch()
    (tmp_path / "symbolic").symlink_to(source)
    os.link(source, tmp_path / "hard")
    for target in (source, tmp_path / "symbolic", tmp_path / "hard", tmp_path / "deep" / ".." / "star.off"):
        (tmp_path / "deep").mkdir(exist_ok=True)
        job = cli["jobs"].Job(tmp_path / "other.off", target, overwrite=True)
        assert str(source) in cli["jobs"].refused_jobs([job], [source])[job]
    (tmp_path / "report.json").touch()
    job = cli["jobs"].Job(tmp_path / "other.off", tmp_path / "report")
    assert cli["jobs"].refused_jobs([job], [tmp_path / "report.json"])


def test_a_file_that_is_named_twice_is_done_once(cli, tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "in")
    (tmp_path / "in" / "star.off").touch()
    files = [tmp_path / "in" / "star.off", tmp_path / "link" / "star.off", tmp_path / "in" / ".." / "in" / "star.off"]
    for output in (None, tmp_path / "out"):
        (job,) = cli["jobs"].jobs_of_files(files, output, lambda path: f"new_{path.name}")
        assert job.path == files[0]


@pytest.fixture
def finished(cli, tmp_path):
    """A job with its result and the report of it."""
    (tmp_path / "star.off").write_text("OFF")
    (tmp_path / "star_parts.off").write_text("OFF")
    (job,) = cli["jobs"].jobs_of_files([tmp_path / "star.off"], None, cli["formats"].name_of_divided)
    told = {"file": "star.off", "seconds": 1.0, "output": "star_parts.off"}
    report = {"digest": cli["digests"].digest_of(job.path), "settings": {"level": 2}, "objects": [], **told}
    written = {"source": "star.off", "files": {"star_parts.off": cli["digests"].digest_of(job.target)}}
    cli["report"].path_beside(job.target).write_text(cli["report"].as_line({**report, "written": written}))
    return job


def test_what_would_come_out_the_same_is_finished(cli, finished):
    report = cli["resume"].finished_report(finished, {"level": 2})
    assert report["skipped"]
    assert (report["file"], report["output"]) == (str(finished.path), str(finished.target))
    assert "written" not in report


CHANGES = {
    "other settings": lambda job, beside: {"level": 3},
    "another source": lambda job, beside: job.path.write_text("OFF 1"),
    "no result": lambda job, beside: job.target.unlink(),
    "an empty result": lambda job, beside: job.target.write_text(""),
    "no report": lambda job, beside: beside.unlink(),
    "half a report": lambda job, beside: beside.write_text(beside.read_text()[:40]),
    "a list for a report": lambda job, beside: beside.write_text("[1]"),
    "a report of an error": lambda job, beside: beside.write_text(
        json.dumps(json.loads(beside.read_text()) | {"error": "no"})
    ),
    "a report of another version": lambda job, beside: beside.write_text(
        json.dumps(json.loads(beside.read_text()) | {"version": 0})
    ),
}


@pytest.mark.parametrize("change", CHANGES)
def test_what_would_come_out_otherwise_is_not(cli, finished, change):
    settings = CHANGES[change](finished, cli["report"].path_beside(finished.target))
    settings = settings if isinstance(settings, dict) else {"level": 2}
    assert cli["resume"].finished_report(finished, settings) is None


def test_what_was_written_here_is_known_by_its_report_alone(cli, finished, tmp_path):
    is_result = cli["resume"].is_result
    assert is_result(finished.target)
    assert not is_result(finished.path)
    finished.target.write_text("a result that was changed")
    assert is_result(finished.target)
    beside = cli["report"].path_beside(finished.target)
    beside.rename(tmp_path / "spare_parts.off.json")
    (tmp_path / "spare_parts.off").touch()
    assert not is_result(tmp_path / "spare_parts.off")
    assert not is_result(finished.target)


def test_a_digest_is_that_of_the_content(cli, tmp_path):
    texts = [b"", b"a", b"b", b"a" * (1 << 20), b"a" * (1 << 20) + b"b"]
    digests = []
    for number, text in enumerate(texts):
        (tmp_path / str(number)).write_bytes(text)
        (tmp_path / f"copy of {number}").write_bytes(text)
        digests.append(cli["digests"].digest_of(tmp_path / str(number)))
        assert cli["digests"].digest_of(tmp_path / f"copy of {number}") == digests[-1]
    assert all(one != other for one, other in itertools.combinations(digests, 2))
