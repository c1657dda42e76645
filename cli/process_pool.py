"""Do files in processes of their own, here or on a cluster, so that a crash takes one file with it at most.

Each process is this command line once more. What starts and awaits it may be any ``concurrent.futures.Executor``:
threads here, or the workers of a cluster, which then need nothing of Eigenparts in their own memory.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path

import bpy

from ..operators.messages.user_errors import MISSING_SCIPY, Refusal
from .atomic_write import remove_stale
from .jobs import Job
from .report import Report, without_version
from .run_serial import failed_report

# A process does up to so many files, as it takes a second or two to start.
MOST_FILES = 16
# And no more than this share of what each process will do in all, so that none is left with all the rest.
SHARE = 1 / 4
# Processes of a cluster, as far as that share is concerned; how many it has is nobody's business here.
CLUSTER = 16
# Seconds to wait for its scheduler.
PATIENCE = 10
# The options that a process is given, besides the layers of a transfer.
OPTIONS = {
    "--object": "object",
    "--field": "field",
    "--shells": "shells",
    "--level": "level",
    "--threshold": "threshold",
    "--parts": "n_parts",
    "--mode": "mode",
    "--source": "source",
    "--reference": "reference",
}
THREAD_SETTINGS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Unit:
    """The files that one process does.

    Attributes
    ----------
    jobs : tuple of Job
        Their results go into one folder.
    was_tried : bool
        Whether a process already ended while it worked on the first of them.
    """

    jobs: tuple[Job, ...]
    was_tried: bool = False


@dataclass
class ProcessPool:
    """Processes that do files, each of them this command line once more.

    Attributes
    ----------
    executor : Executor
    command : list of str
        What starts this command line on the machine that a process runs on.
    arguments : list of str
        The command and its options.
    n_processes : int
    environment : dict, optional
        Of the processes; the one that they find if None.
    timeout : float, optional
        Seconds that a process has, which then does one file only.
    """

    executor: Executor
    command: list[str]
    arguments: list[str]
    n_processes: int
    environment: dict[str, str] | None = None
    timeout: float | None = None
    _under_way: dict["Future[subprocess.CompletedProcess[str]]", Unit] = field(default_factory=dict)

    def run(self, jobs: Sequence[Job]) -> Iterator[Report]:
        """Yield a report for each file as soon as its process has ended."""
        for unit in _units(jobs, _most_files(len(jobs), self.n_processes) if self.timeout is None else 1):
            self._submit(unit)
        try:
            while self._under_way:
                done, _ = wait(self._under_way, return_when=FIRST_COMPLETED)
                for future in done:
                    yield from self._harvest(self._under_way.pop(future), future)
        finally:
            # After an interrupt, what has not begun is not begun any more.
            for future in self._under_way:
                future.cancel()

    def _submit(self, unit: Unit) -> None:
        files = [str(job.path.absolute()) for job in unit.jobs]
        output = ["--output", str(unit.jobs[0].target.parent.absolute()), "--json-lines"]
        call = partial(
            subprocess.run,
            [*self.command, *self.arguments, *output, "--", *files],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            env=self.environment,
            timeout=self.timeout,
        )
        self._under_way[self.executor.submit(call)] = unit

    def _harvest(self, unit: Unit, future: "Future[subprocess.CompletedProcess[str]]") -> Iterator[Report]:
        try:
            process = future.result()
        except subprocess.TimeoutExpired:
            # It was killed, and a second try would take as long.
            _clear_up(unit.jobs[0])
            yield failed_report(unit.jobs[0], f"it took longer than {self.timeout:g} seconds.")
            return
        except (Exception, CancelledError) as error:
            # The process could not be started, or the machine is gone.
            yield from self._try_again(unit, f"{type(error).__name__}: {error}")
            return
        reports = _reports_in(process.stdout)
        for job, report in zip(unit.jobs, reports, strict=False):
            yield _as_given(report, job)
        if len(reports) < len(unit.jobs):
            yield from self._try_again(Unit(unit.jobs[len(reports) :], unit.was_tried), _end_of(process))

    def _try_again(self, unit: Unit, problem: str) -> Iterator[Report]:
        """Give the file at which a process ended a second chance, alone, and the others behind it a new process."""
        first, *others = unit.jobs
        _clear_up(first)
        if unit.was_tried:
            yield failed_report(first, f"its process ended twice before the file was done: {problem}")
        else:
            self._submit(Unit((first,), was_tried=True))
        if others:
            self._submit(Unit(tuple(others)))


@contextmanager
def local_pool(options: argparse.Namespace) -> Iterator[ProcessPool]:
    """Yield a pool of processes on this machine."""
    share = str(max(1, (os.cpu_count() or 1) // options.jobs))
    environment = {**dict.fromkeys(THREAD_SETTINGS, share), **os.environ}
    with ThreadPoolExecutor(options.jobs) as executor:
        yield ProcessPool(
            executor=executor,
            command=own_command(),
            arguments=_arguments_of(options),
            n_processes=options.jobs,
            environment=environment,
            timeout=options.timeout,
        )


@contextmanager
def cluster_pool(options: argparse.Namespace) -> Iterator[ProcessPool]:
    """Yield a pool of processes on the machines of a dask cluster."""
    try:
        from distributed import Client
    except ImportError as error:
        raise Refusal('--scheduler needs dask in this Python: pip install "distributed".') from error
    try:
        # Dask has no types here.
        client = Client(options.scheduler, timeout=PATIENCE)  # type: ignore[no-untyped-call]
    except (OSError, ValueError) as error:
        raise Refusal(f"no dask scheduler answers at {options.scheduler}.") from error
    with client, client.get_executor() as executor:  # type: ignore[no-untyped-call]
        command = options.worker_command or own_command()
        yield ProcessPool(
            executor=executor,
            command=command,
            arguments=_arguments_of(options),
            n_processes=CLUSTER,
            timeout=options.timeout,
        )


def _arguments_of(options: argparse.Namespace) -> list[str]:
    """Return the command and the options that decide what becomes of a file, to give them to another process."""
    command = "transfer" if options.command == "transfer" else "register" if options.source else "segment"
    given = vars(options) | {"source": options.source and options.source.absolute()}
    values = {name: given[key] for name, key in OPTIONS.items() if given.get(key) is not None}
    layers = [f"--layers={','.join(options.layers)}"] if command == "transfer" else []
    switches = [f"--{name}" for name in ("mirrored", "overwrite") if getattr(options, name)]
    return [command, *(f"{name}={value}" for name, value in values.items()), *layers, *switches]


def own_command() -> list[str]:
    """Return what starts this command line on this machine: the application, or Python with Blender as a module."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--background", "--command", "eigenparts"]
    scipy = find_spec("scipy")
    if scipy is None or scipy.origin is None:
        raise Refusal(MISSING_SCIPY)
    folder_of_scipy = Path(scipy.origin).parents[1]
    return [sys.executable, "-P", str(Path(__file__).with_name("launch.py")), str(folder_of_scipy)]


def _most_files(n_jobs: int, n_processes: int) -> int:
    """Return how many files a process does, so that all have enough to do."""
    return max(1, min(MOST_FILES, int(n_jobs * SHARE / n_processes)))


def _units(jobs: Sequence[Job], size: int) -> Iterator[Unit]:
    for _, group in groupby(jobs, key=lambda job: job.target.parent):
        same_folder = tuple(group)
        yield from (Unit(same_folder[start : start + size]) for start in range(0, len(same_folder), size))


def _clear_up(job: Job) -> None:
    """Remove what a process left that ended while it wrote a result."""
    remove_stale(job.target.parent)


def _reports_in(text: str) -> list[Report]:
    """Return the reports among what a process has said; Blender says other things there."""
    return [json.loads(line) for line in text.splitlines() if line.startswith('{"version"') and line.endswith("}")]


def _as_given(report: Report, job: Job) -> Report:
    """Return a report with paths as the user gave them."""
    given = without_version(report)
    given["file"] = str(job.path)
    if "output" in given:
        given["output"] = str(job.target)
    return given


def _end_of(process: "subprocess.CompletedProcess[str]") -> str:
    last_line = process.stderr.strip().splitlines()[-1:]
    cause = f"signal {-process.returncode}" if process.returncode < 0 else f"exit code {process.returncode}"
    return ", ".join([cause, *last_line]) + "."
