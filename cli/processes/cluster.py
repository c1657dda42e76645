"""Do files on the machines of a dask cluster, each in a process of its own.

The workers of the cluster need nothing of Eigenparts in their own memory: they start this command line once more.
"""

import argparse
import subprocess
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from typing import TypeAlias

from ...tasks.refusals import Refusal
from ..jobs import Job, failed_report
from ..reports.report import Report
from .child_process import own_command, reports_in
from .pool import LONG, Unit, arguments_of, as_given, clear_up, files_of
from .verdict import ProcessEnd, too_slow

# Seconds to wait for its scheduler.
PATIENCE = 10

Process: TypeAlias = "Future[subprocess.CompletedProcess[str]]"


@dataclass
class ClusterPool:
    """Processes on a cluster.

    Attributes
    ----------
    executor : Executor
        Starts and awaits them.
    command : list of str
        What starts this command line where they run, with its options.
    timeout : float
        Seconds that a file may take.
    """

    executor: Executor
    command: list[str]
    timeout: float
    _under_way: dict[Process, Unit] = field(default_factory=dict)

    def run(self, jobs: Sequence[Job]) -> Iterator[Report]:
        """Yield a report for each file as soon as it is done."""
        for job in jobs:
            self._submit(Unit((job,)))
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
        call = partial(
            subprocess.run,
            [*self.command, *files_of(unit)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            timeout=self.timeout,
        )
        self._under_way[self.executor.submit(call)] = unit

    def _harvest(self, unit: Unit, future: Process) -> Iterator[Report]:
        (job,) = unit.jobs
        try:
            process = future.result()
        except subprocess.TimeoutExpired:
            clear_up(unit.jobs)
            yield failed_report(job, too_slow(self.timeout))
        except (Exception, CancelledError) as error:
            # The process could not be started, or the machine is gone.
            yield from self._try_again(unit, f"its machine failed twice: {error}")
        else:
            end = ProcessEnd(process.returncode, process.stderr)
            if reports := reports_in(process.stdout.splitlines()):
                yield as_given(reports[0], job)
                return
            clear_up(unit.jobs)
            if end.is_from_outside:
                yield from self._try_again(unit, end.sentence())
            else:
                yield failed_report(job, end.sentence())

    def _try_again(self, unit: Unit, problem: str) -> Iterator[Report]:
        if unit.was_tried:
            yield failed_report(unit.jobs[0], problem)
        else:
            self._submit(Unit(unit.jobs, was_tried=True))


@contextmanager
def cluster_pool(options: argparse.Namespace) -> Iterator[ClusterPool]:
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
        command = [*(options.worker_command or own_command()), *arguments_of(options)]
        yield ClusterPool(executor, command, options.timeout or LONG)
