"""One long computation in the worker process, so that the window stays alive."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Generic, TypeVar, cast

from ...compute.progress import Progress, silent
from ...tasks.processes import WorkerProcess
from ...tasks.refusals import Refusal
from ...tasks.threads import use_threads
from ...tasks.tracebacks import keep_traceback
from ...tasks.worker_messages import Answer, Failure, Ready, Report, Task, Told
from . import worker_process
from .user_preferences import preferred_processes, preferred_threads

Result = TypeVar("Result")

# Seconds that a worker may take to start; on a slow disk, or behind a program that looks for viruses.
START = 60.0
NO_WORKER = "No process could be started for this, so Blender itself computed it, and could not be used meanwhile."
ENDED = "The process that computed this has ended, perhaps for lack of memory; nothing was changed. Try it again."


class Job(Generic[Result]):
    """Run ``work(progress)`` in the worker, in Blender itself where there can be none.

    Whoever started the job calls ``look`` until it is true, and then takes ``result()``; a cancelled job is never
    asked for its result.

    Attributes
    ----------
    fraction : float
        How much of the work is done, 0 to 1.
    text : str
        What is being done, for the user.
    is_cancelled : bool
    """

    def __init__(self, work: Callable[[Progress], Result]) -> None:
        self._report(0.0, "Starting")
        self.is_cancelled = False
        self._task = Task(work, preferred_threads(), preferred_processes())
        self._outcome: Answer | Failure | None = None
        self._worker: WorkerProcess | None = None
        try:
            self._worker = worker_process.running_worker()
        except OSError:
            return
        if self._worker.is_ready:
            self._hand_over(self._worker)

    @property
    def is_in_blender(self) -> bool:
        """Whether there is no worker for it."""
        return self._worker is None

    def look(self) -> bool:
        """Take in what the worker has told; return whether a result or an error is ready, or no worker will do it."""
        worker = self._worker
        if worker is None or self._outcome is not None:
            return True
        try:
            while self._outcome is None and worker.channel.poll():
                self._take_in(worker.told(), worker)
        except (EOFError, OSError):
            self._lose(worker)
        if not worker.is_ready and time.monotonic() - worker.started > START:
            self._lose(worker)
        return self._worker is None or self._outcome is not None

    def cancel(self) -> None:
        """End the work at once, whatever it does."""
        self.is_cancelled = True
        if self._worker is not None and self._outcome is None:
            worker_process.stop_worker()

    def result(self) -> Result:
        """Return what the work returned, or raise what it raised."""
        if self._worker is None:
            use_threads(self._task.n_threads)
            return cast(Result, self._task.work(silent))
        if isinstance(self._outcome, Failure):
            keep_traceback(self._outcome.error, self._outcome.traceback)
            raise self._outcome.error
        assert self._outcome is not None
        return cast(Result, self._outcome.result)

    def _take_in(self, told: Told, worker: WorkerProcess) -> None:
        if isinstance(told, Ready):
            worker.is_ready = True
            self._hand_over(worker)
        elif isinstance(told, Report):
            self._report(told.fraction, told.text)
        else:
            self._outcome = told
            worker.is_busy, worker.used = False, time.monotonic()

    def _report(self, fraction: float, text: str) -> None:
        self.fraction, self.text = fraction, text

    def _hand_over(self, worker: WorkerProcess) -> None:
        try:
            worker.hand_over(self._task)
        except OSError:
            self._lose(worker)

    def _lose(self, worker: WorkerProcess) -> None:
        """Take leave of a worker that has ended; one that was never ready leaves the work to Blender."""
        worker_process.stop_worker()
        if worker.is_ready:
            self._outcome = Failure(Refusal(ENDED), "")
        else:
            self._worker = None
