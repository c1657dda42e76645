"""Work in the worker process: one task after the other, until Blender closes the connection."""

from __future__ import annotations

import ctypes
import pickle
import shutil
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from pathlib import Path

from .. import compute
from ..compute.memory import claim_buffers
from ..compute.progress import Progress
from . import parcels, recent_results, shared_calls
from .shared_calls import Sharing
from .threads import use_threads
from .tracebacks import traceback_without_folders
from .worker_messages import INTERVAL, Answer, Failure, Ready, Report

# Folder of what was computed last, in that of the worker.
RECENT = "recent"
# Of Linux: the signal that a process gets when its parent ends.
SET_PARENT_DEATH_SIGNAL = 1


def serve(channel: Connection, folder: str, is_helper: bool) -> None:
    """Say that the worker is ready, and answer tasks; the folder goes with Blender."""
    place = Path(folder)
    recent_results.keep_in(place / RECENT)
    # Blender has closed the connection, or is gone.
    with suppress(EOFError, OSError):
        _load_engine()
        parcels.send(channel, Ready(), place)
        while True:
            _send(channel, _next_answer(channel, place), place)
    if not is_helper:
        shutil.rmtree(place, ignore_errors=True)


def _load_engine() -> None:
    """Load all that is loaded when it is first asked for elsewhere: a memory that is full later cannot break that."""
    for name in compute.__all__:
        getattr(compute, name)
    claim_buffers()


def _next_answer(channel: Connection, folder: Path) -> Answer | Failure:
    parcel = parcels.receive(channel)
    try:
        task = parcel.unpacked()
        with _ended_with_blender():
            use_threads(task.n_threads)
            shared_calls.share(Sharing(task.n_processes, task.n_threads, folder))
            return Answer(task.work(_reporter(channel, folder)))
    except Exception as error:
        # Whatever it is, it is raised again in Blender.
        return _failure(error)


def _send(channel: Connection, answer: Answer | Failure, folder: Path) -> None:
    try:
        parcels.send(channel, answer, folder)
    except MemoryError as error:
        # Nothing was sent: a value is packed as a whole first.
        parcels.send(channel, _failure(error), folder)


def _failure(error: Exception) -> Failure:
    traceback = traceback_without_folders(error)
    try:
        return Failure(pickle.loads(pickle.dumps(error)), traceback)
    except Exception:
        # Errors of libraries may ask for more than their text when they are made again.
        return Failure(RuntimeError(type(error).__name__), traceback)


def _reporter(channel: Connection, folder: Path) -> Progress:
    """Return a callback that tells Blender how far the work is, now and then."""
    last = -INTERVAL

    def report(fraction: float, text: str) -> None:
        nonlocal last
        if time.monotonic() - last >= INTERVAL:
            last = time.monotonic()
            parcels.send(channel, Report(fraction, text), folder)

    return report


@contextmanager
def _ended_with_blender() -> Iterator[None]:
    """Let the system end this process together with Blender, in the middle of a factorization too, where it can.

    Elsewhere the next report of progress finds the connection closed.
    """
    if not sys.platform.startswith("linux"):
        yield
        return
    system = ctypes.CDLL(None)
    system.prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    try:
        yield
    finally:
        # Without work it ends by itself, and takes its folder along.
        system.prctl(SET_PARENT_DEATH_SIGNAL, 0)
