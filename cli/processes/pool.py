"""Do files in processes of their own, so that one that crashes, hangs or takes all memory costs nothing but itself.

Each process is this command line once more, here or on a cluster.
"""

import argparse
import os
import tempfile
import time
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path

from ..jobs import Job, failed_report
from ..reports.report import Report, without_version
from ..results.stages import remove_stale
from .child_process import GRACE, ChildProcess, own_command
from .interrupts import interrupt_held
from .limits import memory_share
from .supervision import SUPERVISED
from .verdict import ProcessEnd, too_slow

# A process that does several files does up to so many.
MOST_FILES = 16
# And no more than this share of what each process will do in all, so that none is left with all the rest.
SHARE = 1 / 4
# Seconds that a file may take if nobody says otherwise.
LONG = 3600.0
# Seconds between two looks at the processes.
PAUSE = 0.02
# The options that a process is given, besides the layers of a transfer.
OPTIONS = {
    "--object": "object",
    "--field": "field",
    "--shells": "shells",
    "--borders": "borders",
    "--level": "level",
    "--threshold": "threshold",
    "--parts": "n_parts",
    "--mode": "mode",
    "--source": "source",
    "--reference": "reference",
    "--points": "points",
    "--memory-limit": "memory_limit",
}
THREAD_SETTINGS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Unit:
    """The files that one process does, one after the other.

    Attributes
    ----------
    jobs : tuple of Job
    was_tried : bool
        Whether a process already ended while it worked on the first of them.
    """

    jobs: tuple[Job, ...]
    was_tried: bool = False


@dataclass
class _Worker:
    """A process at work on a unit."""

    process: ChildProcess
    unit: Unit
    n_done: int = 0

    @property
    def left(self) -> tuple[Job, ...]:
        return self.unit.jobs[self.n_done :]


@dataclass
class ProcessPool:
    """Processes of this machine that do files.

    Attributes
    ----------
    arguments : list of str
        The command and its options.
    n_processes : int
    timeout : float
        Seconds that a file may take.
    folder : Path
        For what the processes say.
    """

    arguments: list[str]
    n_processes: int
    timeout: float
    folder: Path
    _workers: list[_Worker] = field(default_factory=list)
    _waiting: deque[Unit] = field(default_factory=deque)
    _first_free: int = 0

    def run(self, units: Iterable[Unit]) -> Iterator[Report]:
        """Yield a report for each file as soon as it is done."""
        self._waiting.extend(units)
        try:
            while self._waiting or self._workers:
                yield from self._fill()
                for worker in tuple(self._workers):
                    yield from self._look_at(worker)
                time.sleep(PAUSE)
        finally:
            for worker in self._workers:
                worker.process.kill()
                clear_up(worker.left)

    def _fill(self) -> Iterator[Report]:
        while self._waiting and len(self._workers) < self.n_processes:
            unit = self._waiting.popleft()
            try:
                with interrupt_held():
                    self._workers.append(_Worker(self._start(unit), unit))
            except OSError as error:
                for job in unit.jobs:
                    yield failed_report(job, f"no process could be started: {error.strerror}: {error.filename}.")

    def _start(self, unit: Unit) -> ChildProcess:
        share = str(max(1, (os.cpu_count() or 1) // self.n_processes))
        environment = {**dict.fromkeys(THREAD_SETTINGS, share), **os.environ, SUPERVISED: str(os.getpid())}
        numbering = [f"--first-free={self._first_free}"] if self._first_free else []
        return ChildProcess([*own_command(), *self.arguments, *numbering, *files_of(unit)], environment, self.folder)

    def _look_at(self, worker: _Worker) -> Iterator[Report]:
        """Yield what a process has done, and give what it left to another one if it ended."""
        reports, end = worker.process.poll()
        for job, report in zip(worker.left, reports, strict=False):
            worker.n_done += 1
            self._first_free = max(self._first_free, _first_free_behind(report))
            yield as_given(report, job)
        if end is None and worker.process.seconds <= (self.timeout if worker.left else GRACE):
            return
        self._workers.remove(worker)
        worker.process.kill()
        if worker.left:
            yield from self._end(worker, end)

    def _end(self, worker: _Worker, end: ProcessEnd | None) -> Iterator[Report]:
        """Tell of the file at which a process ended, or try it again if others may be to blame, and do the rest."""
        job, *others = worker.left
        clear_up(worker.left)
        was_tried = worker.unit.was_tried and not worker.n_done
        is_innocent = end is not None and (end.is_from_outside or worker.n_done > 0)
        if is_innocent and not was_tried:
            self._waiting.appendleft(Unit(worker.left, was_tried=True))
            return
        if others:
            self._waiting.appendleft(Unit(tuple(others)))
        yield failed_report(job, too_slow(self.timeout) if end is None else end.sentence())


@contextmanager
def local_pool(options: argparse.Namespace) -> Iterator[ProcessPool]:
    """Yield a pool of processes on this machine."""
    n_processes = options.jobs or 1
    memory_limit = options.memory_limit or memory_share(n_processes)
    limited = argparse.Namespace(**vars(options) | {"memory_limit": memory_limit})
    with tempfile.TemporaryDirectory(prefix="eigenparts-", ignore_cleanup_errors=True) as folder:
        yield ProcessPool(arguments_of(limited), n_processes, options.timeout or LONG, Path(folder))


def units_of(jobs: Sequence[Job], options: argparse.Namespace) -> Iterator[Unit]:
    """Yield what each process does: one file of a batch, many of those that were named, as starting takes a second."""
    if options.command == "batch":
        size = 1
    elif options.jobs:
        size = max(1, min(MOST_FILES, int(len(jobs) * SHARE / options.jobs)))
    else:
        size = max(1, len(jobs))
    for _, group in groupby(jobs, key=lambda job: job.target.parent):
        same_folder = tuple(group)
        yield from (Unit(same_folder[start : start + size]) for start in range(0, len(same_folder), size))


def arguments_of(options: argparse.Namespace) -> list[str]:
    """Return the command and the options that decide what becomes of a file, to give them to another process."""
    command = "transfer" if options.command == "transfer" else "register" if options.source else "segment"
    given = vars(options) | {name: path.absolute() for name in ("source", "points") if (path := vars(options)[name])}
    values = {name: given[key] for name, key in OPTIONS.items() if given.get(key) is not None}
    layers = [f"--layers={','.join(options.layers)}"] if command == "transfer" else []
    switches = [f"--{name}" for name in ("mirrored", "overwrite") if getattr(options, name)]
    return [command, "--in-process", *(f"{name}={value}" for name, value in values.items()), *layers, *switches]


def files_of(unit: Unit) -> list[str]:
    """Return the arguments that say which files a process does, and where their results go."""
    output = str(unit.jobs[0].target.parent.absolute())
    return ["--output", output, "--json-lines", "--", *(str(job.path.absolute()) for job in unit.jobs)]


def as_given(report: Report, job: Job) -> Report:
    """Return a report with paths as the user gave them."""
    given = without_version(report)
    given["file"] = str(job.path)
    if "output" in given:
        given["output"] = str(job.target)
    return given


def clear_up(jobs: Iterable[Job]) -> None:
    """Remove what a process left that ended while it wrote a result."""
    for folder in {job.target.parent for job in jobs}:
        remove_stale(folder)


def _first_free_behind(report: Report) -> int:
    """Return a number above those of all parts of a file."""
    labels = [part["id"] for row in report.get("objects", ()) for part in row.get("parts", ())]
    return 1 + max(labels, default=-1)
