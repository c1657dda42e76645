"""Jobs: a file and its result."""

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from .reports.report import Report, path_beside


@dataclass(frozen=True)
class Job:
    """One file.

    Attributes
    ----------
    path : Path
        As the user gave it.
    target : Path
        Where the result is written.
    overwrite : bool
        Whether it may replace what is not known to be ours.
    """

    path: Path
    target: Path
    overwrite: bool = False


def jobs_of_files(
    files: Iterable[Path], output: Path | None, name_of_result: Callable[[Path], str], *, overwrite: bool = False
) -> list[Job]:
    """Return a job for each file; results go beside the files if there is no folder for them."""
    jobs = [Job(path, (output or path.parent) / name_of_result(path), overwrite) for path in files]
    return first_of_each(jobs, lambda job: (place_of(job.path), place_of(job.target)))


def first_of_each(jobs: Iterable[Job], key: Callable[[Job], object]) -> list[Job]:
    """Return the jobs without those that come after one with the same key."""
    first: dict[object, Job] = {}
    for job in jobs:
        first.setdefault(key(job), job)
    return list(first.values())


def place_of(path: Path) -> tuple[object, str]:
    """Return a key of a place on disk, one for all names that its folder has, whether there is a file or not."""
    folder, name = os.path.split(os.path.realpath(path))
    return _identity(folder) or folder, name


def refused_jobs(jobs: Iterable[Job], sources: Iterable[Path]) -> dict[Job, str]:
    """Return the jobs whose results would replace a source, or the result of an earlier job, with a sentence each."""
    by_identity = {_identity(path): path for path in sources}
    by_identity.pop(None, None)
    first: dict[object, Path] = {}
    refused = {}
    for job in jobs:
        earlier = first.setdefault(place_of(job.target), job.path)
        replaced = [by_identity.get(_identity(path)) for path in (job.target, path_beside(job.target))]
        if source := next(filter(None, replaced), None):
            refused[job] = f"its result would replace {source}, which is to be read; give a folder with --output."
        elif earlier is not job.path:
            refused[job] = f"its result would replace that of {earlier}; give them different folders."
    return refused


def failed_report(job: Job, problem: str) -> Report:
    """Return the report of a file that was not even begun."""
    return {"file": str(job.path), "error": problem, "seconds": 0.0}


def _identity(path: "str | os.PathLike[str]") -> tuple[int, int] | None:
    """Return what all names of a file have in common, None if there is no such file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino
