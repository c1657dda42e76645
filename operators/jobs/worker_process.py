"""The worker process as Blender sees it: started when it is first needed, ended after a rest and with Blender."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import bpy

from ...tasks import processes
from ...tasks.processes import WorkerProcess

# Seconds without work after which a worker ends, and between looks whether it should.
REST, LOOK = 300.0, 5.0
# Of the names of folders, before the number of the Blender.
PREFIX = "eigenparts-"

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
        command = [sys.executable, *getattr(bpy.app, "python_args", ()), "-P", str(processes.START_FILE)]
        _worker = processes.start(command, _session_folder())
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
        # Beside Blender's own folder, which stays unseen where Blender is killed.
        place = Path(bpy.app.tempdir or tempfile.gettempdir())
        place = place.parent if bpy.app.tempdir else place
        _remove_folders_left_behind(place)
        _folder = Path(tempfile.mkdtemp(prefix=f"{PREFIX}{os.getpid()}-", dir=place))
    return _folder


def _remove_folders_left_behind(place: Path) -> None:
    """Remove the folders of Blenders that were killed in the middle of a job, so that nothing could remove them."""
    for folder in place.glob(f"{PREFIX}*-*"):
        number = folder.name.removeprefix(PREFIX).partition("-")[0]
        if number.isdecimal() and not _is_running(int(number)):
            shutil.rmtree(folder, ignore_errors=True)


def _is_running(process: int) -> bool:
    """Whether there is a process of a number; true where nobody can tell."""
    if sys.platform == "win32":
        # To ask would end it.
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        # It is somebody else's, or no number of a process.
        return True
    return True
