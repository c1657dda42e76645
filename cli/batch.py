"""The command ``batch``: all files of folders, but for those that were finished before."""

import argparse
from collections.abc import Iterator
from pathlib import Path

from ..operators.messages.user_errors import Refusal
from .formats import FORMATS, name_of_divided
from .jobs import Job
from .report import Report, Settings
from .resume import finished_report, is_result


def find_jobs(options: argparse.Namespace) -> list[Job]:
    """Return a job for each mesh file below the folders that were named; results keep the order of folders."""
    jobs = [job for folder in options.folders for job in _jobs_below(folder, options)]
    if not jobs:
        raise Refusal(f"there are no files to divide in {', '.join(map(str, options.folders))}.")
    return list({job.path.resolve(): job for job in jobs}.values())


def finished_reports(jobs: list[Job], settings: Settings) -> dict[Job, Report]:
    """Return the jobs that need not be done again, with their reports."""
    reports = {job: finished_report(job, settings) for job in jobs}
    return {job: report for job, report in reports.items() if report is not None}


def _jobs_below(folder: Path, options: argparse.Namespace) -> Iterator[Job]:
    if not folder.is_dir():
        raise Refusal(f"{folder}: there is no such folder.")
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        if _is_wanted(path, inside, options.glob):
            parent = path.parent if options.output is None else options.output / inside.parent
            yield Job(path, parent / name_of_divided(path))


def _is_wanted(path: Path, inside: Path, patterns: list[str]) -> bool:
    is_hidden = any(part.startswith(".") for part in inside.parts)
    is_mesh = path.suffix.lower() in FORMATS and path.is_file()
    is_named = not patterns or any(inside.match(pattern) for pattern in patterns)
    return is_mesh and is_named and not is_hidden and not is_result(path)
