"""One long computation in a worker thread, so that the window stays alive; knows nothing of Blender."""

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Generic, TypeVar

from ...compute.errors import Cancelled
from ...compute.progress import Progress

Result = TypeVar("Result")

# A cancelled job may need seconds to notice; the next one waits here, so that two never compute at once.
_TURN = threading.Lock()


class Job(Generic[Result]):
    """Run ``work(progress)`` in a thread.

    The thread is a daemon: closing Blender does not wait for it. Whoever started the job polls ``is_done`` and takes
    ``result()``; a cancelled job is never asked for its result.

    Attributes
    ----------
    fraction : float
        How much of the work is done, 0 to 1.
    text : str
        What is being done, for the user.
    """

    def __init__(self, work: Callable[[Progress], Result]) -> None:
        self._stop = threading.Event()
        self._report(0.0, "Waiting for the cancelled job to stop")
        self._outcome: Future[Result] = Future()
        threading.Thread(target=self._run, args=[work], daemon=True, name="eigenparts").start()

    @property
    def is_done(self) -> bool:
        """Whether a result or an error is ready."""
        return self._outcome.done()

    @property
    def is_cancelled(self) -> bool:
        """Whether the job was disowned."""
        return self._stop.is_set()

    def cancel(self) -> None:
        """Disown the job: it stops at its next report of progress."""
        self._stop.set()

    def result(self) -> Result:
        """Return what the work returned, or raise what it raised."""
        return self._outcome.result()

    def _run(self, work: Callable[[Progress], Result]) -> None:
        with _TURN:
            try:
                self._report(0.0, "Starting")
                self._outcome.set_result(work(self._report))
            except Exception as error:
                # Whatever it is, it is raised again by result(), in the main thread.
                self._outcome.set_exception(error)

    def _report(self, fraction: float, text: str) -> None:
        if self._stop.is_set():
            raise Cancelled
        self.fraction, self.text = fraction, text
