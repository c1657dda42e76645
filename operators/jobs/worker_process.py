"""The worker process as Blender sees it: started when it is first needed, ended after a rest and with Blender."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import connection
from pathlib import Path
from typing import Any

import bpy

from .user_preferences import PACKAGE

ROOT = Path(__file__).parents[2]
START_FILE = ROOT / "tasks" / "worker_start.py"
# Seconds without work after which a worker ends, and between looks whether it should.
REST, LOOK = 300.0, 5.0


@dataclass(eq=False)
class WorkerProcess:
    """A process that computes for this Blender.

    Attributes
    ----------
    process : Popen
    channel : Connection
        To be polled; whatever ends the process closes it.
    folder : Path
        Of large arrays and of what was computed last.
    is_ready : bool
        Whether it has told that it takes tasks.
    is_busy : bool
        Whether it has one, however long that takes.
    started, used : float
        When it was started, and when it last had work, in the seconds of ``time.monotonic``.
    """

    process: subprocess.Popen[bytes]
    channel: connection.Connection
    folder: Path
    is_ready: bool = False
    is_busy: bool = False
    started: float = field(default_factory=time.monotonic)
    used: float = field(default_factory=time.monotonic)

    @property
    def is_alive(self) -> bool:
        """Whether the process has not ended; one that has is taken leave of by this."""
        return self.process.poll() is None

    def kill(self) -> None:
        """End the process, whatever it does, and wait for that: some milliseconds."""
        self.process.kill()
        self.process.wait()
        self.channel.close()


_worker: WorkerProcess | None = None
_folder: Path | None = None


def running_worker() -> WorkerProcess:
    """Return the worker, a new one if there is none.

    Raises
    ------
    OSError
        If the system starts none.
    """
    global _worker
    if _worker is not None and not _worker.is_alive:
        stop_worker()
    if _worker is None:
        _worker = _start(_session_folder())
        if not bpy.app.timers.is_registered(_end_after_rest):
            bpy.app.timers.register(_end_after_rest, first_interval=LOOK, persistent=True)
    _worker.used = time.monotonic()
    return _worker


def stop_worker() -> None:
    """End the worker, if there is one; what it has kept is there for the next one."""
    global _worker
    if _worker is not None:
        _worker.kill()
    _worker = None


def end_session() -> None:
    """End the worker, and remove all that it has kept."""
    global _folder
    stop_worker()
    if bpy.app.timers.is_registered(_end_after_rest):
        bpy.app.timers.unregister(_end_after_rest)
    if _folder is not None:
        shutil.rmtree(_folder, ignore_errors=True)
    _folder = None


def _end_after_rest() -> float | None:
    """Timer of Blender's: end a worker that rests, and take leave of one that has ended."""
    if _worker is not None and not (_worker.is_alive and (_worker.is_busy or time.monotonic() - _worker.used < REST)):
        stop_worker()
    return LOOK if _worker is not None else None


def _session_folder() -> Path:
    global _folder
    if _folder is None or not _folder.is_dir():
        _folder = Path(tempfile.mkdtemp(prefix="eigenparts-", dir=bpy.app.tempdir or None))
    return _folder


def _start(folder: Path) -> WorkerProcess:
    ours, theirs = connection.Pipe()
    handle = theirs.fileno()
    command = [sys.executable, *getattr(bpy.app, "python_args", ()), "-P", str(START_FILE), str(handle)]
    with theirs:
        try:
            process = subprocess.Popen(command, **_options(handle))
        except OSError:
            ours.close()
            raise
    # One that ends at once is noticed when it is looked at.
    with suppress(OSError):
        ours.send((PACKAGE, str(ROOT), sys.path, str(folder)))
    return WorkerProcess(process, ours, folder)


def _options(handle: int) -> dict[str, Any]:
    """Return how a process is started that has one end of a connection, and neither console nor output."""
    silent = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    if sys.platform != "win32":
        return {**silent, "pass_fds": [handle]}
    os.set_handle_inheritable(handle, True)
    startup = subprocess.STARTUPINFO(lpAttributeList={"handle_list": [handle]})
    return {**silent, "startupinfo": startup, "creationflags": subprocess.CREATE_NO_WINDOW}
