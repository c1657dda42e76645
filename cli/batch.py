"""The command ``batch``: all files of folders, but for those that were finished before."""

import argparse
import os
from collections.abc import Iterator
from pathlib import Path

from ..tasks.refusals import Refusal
from .formats import FORMATS, name_of_divided
from .jobs import Job, first_of_each, place_of
from .reports.report import Report, Settings
from .results.resume import finished_report, is_result, may_be_result


def find_jobs(options: argparse.Namespace) -> list[Job]:
    """Return a job for each mesh file below the folders that were named; results keep the order of folders."""
    found = [job for folder in options.folders for job in _jobs_below(folder, options)]
    jobs = _without_doubtful(first_of_each(found, lambda job: place_of(job.path)))
    if not jobs:
        raise Refusal(f"there are no files to divide in {', '.join(map(str, options.folders))}.")
    return jobs


def finished_reports(jobs: list[Job], settings: Settings) -> dict[Job, Report]:
    """Return the jobs that need not be done again, with their reports."""
    reports = {job: finished_report(job, settings) for job in jobs}
    return {job: report for job, report in reports.items() if report is not None}


def _jobs_below(folder: Path, options: argparse.Namespace) -> Iterator[Job]:
    if not folder.is_dir():
        is_there = "it is a file; segment does single files." if folder.exists() else "there is no such folder."
        raise Refusal(f"{folder}: {is_there}")
    for path in sorted(_visible_files(folder)):
        inside = path.relative_to(folder)
        if _is_wanted(path, inside, options.glob):
            parent = path.parent if options.output is None else options.output / inside.parent
            yield Job(path, parent / name_of_divided(path), options.overwrite)


def _visible_files(folder: Path) -> Iterator[Path]:
    """Yield the files below a folder, which other processes may change meanwhile."""
    for parent, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        yield from (Path(parent, name) for name in names if not name.startswith("."))


def _without_doubtful(jobs: list[Job]) -> list[Job]:
    """Leave out what may be the result of another file, though its report does not say so; that file tells of it."""
    targets = {place_of(job.target) for job in jobs}
    return [job for job in jobs if place_of(job.path) not in targets or not may_be_result(job.path)]


def _is_wanted(path: Path, inside: Path, patterns: list[str]) -> bool:
    is_mesh = path.suffix.lower() in FORMATS and path.is_file()
    is_named = not patterns or any(inside.match(pattern) for pattern in patterns)
    return is_mesh and is_named and not is_result(path)
