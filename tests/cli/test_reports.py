"""What is told of each file, for people and for programs."""

import io
import json
from importlib import import_module

import pytest

from tools.extension import load_extension

DONE = {
    "file": "star.off",
    "output": "star_parts.off",
    "seconds": 1.26,
    "objects": [{"name": "star", "parts": [{}, {}, {}]}, {"name": "dot", "error": "The mesh has no faces."}],
}
FAILED = {"file": "bad.off", "error": "there is no such file.", "seconds": 0.0}
SKIPPED = DONE | {"file": "old.off", "skipped": True}


@pytest.fixture(scope="module")
def cli():
    load_extension()
    names = ("reports.report", "reports.reporters", "arguments", "formats.file_errors")
    return {name.rpartition(".")[2]: import_module(f"eigenparts.cli.{name}") for name in names}


def told(cli, options, reports, err=None):
    """Return what stands on stdout after each report, and at the end."""
    out, steps = io.StringIO(), []
    chosen = cli["arguments"].parse(["segment", "star.off", *options])
    reporter = cli["reporters"].reporter_for(chosen, out, err or io.StringIO())
    for report in reports:
        reporter.add(report)
        steps.append(out.getvalue())
    reporter.close()
    return steps, out.getvalue()


def test_people_read_a_sentence_for_each_file_that_went_well(cli):
    steps, text = told(cli, [], [DONE, FAILED, SKIPPED])
    assert text == "star.off: star: 3 parts, 1.3 s, written to star_parts.off\n"
    assert steps[0] == text


def test_people_read_the_warnings_of_what_was_done_now(cli):
    warned = DONE | {"warnings": ["kept."], "objects": [DONE["objects"][0] | {"warnings": ["2 points moved."]}]}
    err = io.StringIO()
    told(cli, [], [warned, warned | {"skipped": True}], err)
    assert err.getvalue() == "star.off: kept.\nstar.off: star: 2 points moved.\n"
    told(cli, ["--json"], [warned], err := io.StringIO())
    assert err.getvalue() == ""


def test_a_line_of_json_is_there_as_soon_as_its_file_is_done(cli):
    steps, text = told(cli, ["--json-lines"], [DONE, FAILED])
    assert steps[-1] == text
    assert [json.loads(line) for line in text.splitlines()] == [{"version": 1, **DONE}, {"version": 1, **FAILED}]
    assert len(steps[0].splitlines()) == 1


def test_one_document_comes_at_the_end(cli):
    steps, text = told(cli, ["--json"], [DONE, FAILED])
    assert steps == ["", ""]
    assert json.loads(text) == {"version": 1, "files": [DONE, FAILED]}


class Terminal(io.StringIO):
    def isatty(self):
        return True


def progress(cli, err, n_finished_before=0):
    line = cli["reporters"].ProgressLine(err, 3, n_finished_before)
    assert list(line.counting([DONE, FAILED, DONE])) == [DONE, FAILED, DONE]
    return err.getvalue()


def test_a_terminal_has_one_line_that_is_written_over(cli):
    lines = progress(cli, Terminal()).split("\r\x1b[K")
    assert len(lines) == 4
    assert lines[0] == "0 of 3 files"
    assert lines[-1].startswith("3 of 3 files, 1 failed, ")
    assert [line.count("\n") for line in lines] == [0, 0, 0, 1]


def test_a_log_has_the_beginning_and_the_end(cli):
    first, last = progress(cli, io.StringIO(), n_finished_before=7).splitlines()
    assert first == "0 of 3 files (7 finished before)"
    assert last.startswith("3 of 3 files (7 finished before), 1 failed, ")


def test_what_went_wrong_is_one_line_that_names_the_file(cli):
    problem_of = cli["file_errors"].problem_of
    assert problem_of(FileNotFoundError(2, "No such file or directory", "x.off")) == (
        "No such file or directory: x.off."
    )
    assert problem_of(OSError(28, "No space left on device")) == "No space left on device."
    assert problem_of(MemoryError()).startswith("there is not enough memory for this file; decimate its meshes")
    assert problem_of(ValueError("two\n  lines")) == (
        "something went wrong that should not; please report it, with the file if you can."
    )


def test_what_could_not_be_written_is_told_without_the_folder_it_is_written_in_at_first(cli):
    problem_of = cli["file_errors"].problem_of
    staged = "out/.eigenparts-x_parts.obj/x_parts.obj"
    assert problem_of(OSError(13, "Permission denied", staged)) == "Permission denied: out/x_parts.obj."
    assert problem_of(RuntimeError(f"Error: Cannot open file {staged}\n")) == (
        "Blender could not write it: Cannot open file out/x_parts.obj."
    )
    traceback = (
        'Error: Python: Traceback (most recent call last):\n  File "x"\nOSError: [Errno 28] No space left on device'
    )
    assert problem_of(RuntimeError(traceback)) == "Blender could not write it: No space left on device."


def test_what_is_hardly_ever_right_counts_as_failed(cli):
    rows = [{"name": "hand", "confidence": 0.04, "parts": []}, {"name": "foot", "confidence": 0.06, "parts": []}]
    assert cli["report"].problems_of(rows).startswith("hand: it is matched with a confidence of 4% only, so its parts ")
    assert cli["report"].problems_of(rows[1:]) == ""


def test_what_is_wrong_with_objects_is_told_with_their_names(cli):
    assert cli["report"].problems_of(DONE["objects"]) == "dot: The mesh has no faces."
    assert cli["report"].problems_of(DONE["objects"][:1]) == ""
