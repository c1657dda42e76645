"""Jobs: a file and its result."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Job:
    """One file.

    Attributes
    ----------
    path : Path
        As the user gave it.
    target : Path
        Where the result is written.
    """

    path: Path
    target: Path


def jobs_of_files(files: Iterable[Path], output: Path | None, name_of_result: Callable[[Path], str]) -> list[Job]:
    """Return a job for each file; results go beside the files if there is no folder for them."""
    return [Job(path, (output or path.parent) / name_of_result(path)) for path in dict.fromkeys(files)]


def conflicting_jobs(jobs: Iterable[Job]) -> dict[Job, Path]:
    """Return the jobs whose results would replace that of an earlier file, with that file."""
    first: dict[Path, Path] = {}
    earlier = {job: first.setdefault(job.target.absolute(), job.path) for job in jobs}
    return {job: path for job, path in earlier.items() if path != job.path}
