"""Calls of one function, shared among processes where there are several; one after the other in Blender itself."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from multiprocessing import connection
from pathlib import Path
from typing import Any, TypeVar

from ..compute.progress import Progress, section
from . import processes
from .processes import WorkerProcess
from .tracebacks import keep_traceback
from .worker_messages import INTERVAL, Answer, Failure, Ready, Report, Task

Result = TypeVar("Result")


@dataclass(frozen=True)
class Sharing:
    """How many processes share calls, the cores that the matrix libraries of each use, and their folder."""

    n_processes: int
    n_threads: int
    folder: Path


_sharing: Sharing | None = None
_helpers: list[WorkerProcess] = []


def share(sharing: Sharing) -> None:
    """From now on, share calls so; in a worker alone."""
    global _sharing
    _sharing = sharing


def run_all(function: Callable[..., Result], arguments: Sequence[tuple[Any, ...]], progress: Progress) -> list[Result]:
    """Return the results of calls with each of some groups of arguments and a callback for progress.

    They are the same however many processes there are. Of several errors that of the first call is raised.

    Parameters
    ----------
    function : callable
        Of a module, so that other processes find it.
    """
    if _sharing is None or min(_sharing.n_processes, len(arguments)) < 2:
        n = len(arguments)
        steps = (section(progress, k / n, (k + 1) / n) for k in range(n))
        return [function(*given, step) for given, step in zip(arguments, steps, strict=True)]
    tasks = [Task(partial(function, *given), _sharing.n_threads) for given in arguments]
    with _helpers_of(_sharing, len(tasks)) as helpers:
        outcomes = _Round(tasks, helpers, progress).outcomes()
    return [_result(outcome) for outcome in outcomes]


@contextmanager
def _helpers_of(sharing: Sharing, n_calls: int) -> Iterator[list[WorkerProcess]]:
    """Give as many processes as there are to be; they stay for the next calls."""
    # Where the system starts fewer, or none, these do all of it, or this process does.
    with suppress(OSError):
        while len(_helpers) < min(sharing.n_processes, n_calls):
            # The command of this process, with the end of another connection.
            _helpers.append(processes.start(sys.orig_argv[:-1], sharing.folder, is_helper=True))
    try:
        yield _helpers
    finally:
        # Where this is left by an error, nobody waits for their answers any more.
        for helper in [helper for helper in _helpers if helper.is_busy]:
            _dismiss(helper)


def _dismiss(helper: WorkerProcess) -> None:
    helper.kill()
    _helpers.remove(helper)


class _Round:
    """Tasks that are given to helpers, each to the next one that is free."""

    def __init__(self, tasks: list[Task], helpers: list[WorkerProcess], progress: Progress) -> None:
        self._tasks, self._helpers, self._progress = tasks, helpers, progress
        self._waiting = list(range(len(tasks)))
        self._given: dict[WorkerProcess, int] = {}
        self._fractions = [0.0] * len(tasks)
        self._outcomes: dict[int, Answer | Failure] = {}

    def outcomes(self) -> list[Answer | Failure]:
        """Return what became of each task."""
        while len(self._outcomes) < len(self._tasks):
            if not self._helpers:
                self._do_the_rest_here()
                break
            self._hand_over()
            ready = connection.wait([helper.channel for helper in self._helpers], INTERVAL)
            for helper in [helper for helper in self._helpers if helper.channel in ready]:
                self._listen(helper)
        return [self._outcomes[number] for number in range(len(self._tasks))]

    def _hand_over(self) -> None:
        for helper in [helper for helper in self._helpers if helper.is_ready and not helper.is_busy]:
            if self._waiting:
                self._given[helper] = self._waiting.pop(0)
                try:
                    helper.hand_over(self._tasks[self._given[helper]])
                except OSError:
                    self._lose(helper)

    def _listen(self, helper: WorkerProcess) -> None:
        try:
            told = helper.told()
        except (EOFError, OSError):
            self._lose(helper)
            return
        if isinstance(told, Ready):
            helper.is_ready = True
        elif isinstance(told, Report):
            self._fractions[self._given[helper]] = told.fraction
            self._progress(sum(self._fractions) / len(self._fractions), told.text)
        else:
            number = self._given.pop(helper)
            self._outcomes[number], self._fractions[number] = told, 1.0
            helper.is_busy = False

    def _lose(self, helper: WorkerProcess) -> None:
        """Take leave of a helper that has ended, perhaps as the memory was full; others do what it did."""
        _dismiss(helper)
        if helper in self._given:
            self._waiting.insert(0, self._given.pop(helper))

    def _do_the_rest_here(self) -> None:
        for number in self._waiting:
            self._outcomes[number] = Answer(self._tasks[number].work(self._progress))


def _result(outcome: Answer | Failure) -> Any:
    if isinstance(outcome, Failure):
        keep_traceback(outcome.error, outcome.traceback)
        raise outcome.error
    return outcome.result
