"""What there is to do: one file and the folder for its result."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from .formats import target_of


@dataclass(frozen=True)
class Job:
    """One file.

    Attributes
    ----------
    path : Path
        As the user gave it.
    folder : Path
        Where the result goes.
    """

    path: Path
    folder: Path

    @property
    def target(self) -> Path:
        """Where the result is written."""
        return target_of(self.path, self.folder)


def jobs_of_files(files: Iterable[Path], output: Path | None) -> list[Job]:
    """Return a job for each file; results go beside the files if there is no folder for them."""
    return [Job(path, output or path.parent) for path in dict.fromkeys(files)]


def in_the_way(jobs: Iterable[Job]) -> dict[Job, Path]:
    """Return the jobs whose results would replace that of an earlier file, with that file."""
    first: dict[Path, Path] = {}
    earlier = {job: first.setdefault(job.target.absolute(), job.path) for job in jobs}
    return {job: path for job, path in earlier.items() if path != job.path}
