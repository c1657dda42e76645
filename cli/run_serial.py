"""Do one file after the other in this process: open, divide, write, tell."""

import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Protocol

from ..operators.messages.user_errors import Refusal
from . import formats
from .jobs import Job
from .reading.reading_errors import problem_of
from .report import ObjectRow, Report, Settings, path_beside, problems_of, write_beside
from .resume import digest_of
from .suppress_output import blender_is_quiet


class Command(Protocol):
    """A command as it is done with each file."""

    @property
    def settings(self) -> Settings:
        """All that the results depend on besides the files."""

    def open_and_process(self, path: Path) -> list[ObjectRow]:
        """Leave a file open with its meshes changed, and return a row for each."""


def run_in_this_process(jobs: Iterable[Job], command: Command) -> Iterator[Report]:
    """Yield a report for each file when it is done."""
    for job in jobs:
        yield _report(job, partial(_do, job, command))


def failed_report(job: Job, problem: str) -> Report:
    """Return the report of a file that was not even begun."""
    return {"file": str(job.path), "error": problem, "seconds": 0.0}


def _report(job: Job, work: Callable[[], Report]) -> Report:
    start = time.perf_counter()
    report: Report = {"file": str(job.path)}
    try:
        with blender_is_quiet():
            report = work()
            report["seconds"] = round(time.perf_counter() - start, 3)
            if "output" in report:
                write_beside(job.target, report)
    except Exception as error:
        # One broken file must not take the batch down, whatever Blender or the file does.
        report["error"], report["seconds"] = problem_of(error), round(time.perf_counter() - start, 3)
    return report


def _do(job: Job, command: Command) -> Report:
    if not job.path.is_file():
        raise Refusal("there is no such file.")
    report: Report = {"file": str(job.path), "digest": digest_of(job.path), "settings": command.settings}
    report["objects"] = command.open_and_process(job.path)
    if problems := problems_of(report["objects"]):
        report["error"] = problems
    if any("error" not in row for row in report["objects"]):
        job.target.parent.mkdir(parents=True, exist_ok=True)
        # Without its report a result counts as unfinished, should anything happen from here on.
        path_beside(job.target).unlink(missing_ok=True)
        formats.save(job.target)
        report["output"] = str(job.target)
    return report
