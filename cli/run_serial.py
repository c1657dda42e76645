"""Do one file after the other in this process: open, divide, write, tell."""

import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Protocol

from ..tasks.refusals import Refusal
from . import formats
from .formats import OpenFile
from .formats.file_errors import problem_of, reason_of
from .jobs import Job
from .processes.suppress_output import blender_is_quiet
from .reports.report import ObjectRow, Report, Settings, problems_of
from .results.digests import digest_of
from .results.stages import check_room, remove_stale, stage_in
from .results.targets import publish, refuse_before_work


class Command(Protocol):
    """A command as it is done with each file."""

    @property
    def settings(self) -> Settings:
        """All that the results depend on besides the files."""

    def open_and_process(self, path: Path) -> tuple[OpenFile, list[ObjectRow]]:
        """Leave a file open with its meshes changed, and return it with a row for each."""


def run_in_this_process(jobs: Iterable[Job], command: Command) -> Iterator[Report]:
    """Yield a report for each file when it is done."""
    jobs = list(jobs)
    for folder in dict.fromkeys(job.target.parent for job in jobs):
        remove_stale(folder)
    for job in jobs:
        yield _report(job, command)


def _report(job: Job, command: Command) -> Report:
    start = time.perf_counter()
    try:
        with blender_is_quiet():
            return _do(job, command, start)
    except Exception as error:
        # One broken file must not take the batch down, whatever Blender or the file does.
        return {"file": str(job.path), "error": problem_of(error), "seconds": _seconds_since(start)}


def _do(job: Job, command: Command, start: float) -> Report:
    if not job.path.is_file():
        is_folder = job.path.is_dir()
        raise Refusal("it is a folder; batch does all files of folders." if is_folder else "there is no such file.")
    refuse_before_work(job)
    report: Report = {"file": str(job.path), "digest": digest_of(job.path), "settings": command.settings}
    file, report["objects"] = command.open_and_process(job.path)
    if problems := problems_of(report["objects"]):
        report["error"] = problems
    if any("error" not in row for row in report["objects"]):
        _write(job, file, report, start)
    else:
        report["seconds"] = _seconds_since(start)
    return report


def _write(job: Job, file: OpenFile, report: Report, start: float) -> None:
    with stage_in(job.target.absolute().parent) as stage:
        _save(stage / job.target.name, file)
        report["output"], report["seconds"] = str(job.target), _seconds_since(start)
        publish(job, stage, report)


def _save(path: Path, file: OpenFile) -> None:
    try:
        formats.save(path, file)
    except RuntimeError as error:
        check_room(path.parent)
        raise Refusal(f"Blender could not write {path.name}: {reason_of(error)}; is there room on the disk?") from error
    check_room(path.parent)


def _seconds_since(start: float) -> float:
    return round(time.perf_counter() - start, 3)
