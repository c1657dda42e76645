"""A worker process as the one that started it sees it, whether that is Blender or another worker."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing import connection
from pathlib import Path
from typing import Any, cast

from . import parcels
from .worker_messages import Task, Told

ROOT = Path(__file__).parents[1]
START_FILE = Path(__file__).with_name("worker_start.py")
PACKAGE = __package__.rpartition(".")[0]


@dataclass(eq=False)
class WorkerProcess:
    """A process that computes for this one.

    Attributes
    ----------
    process : Popen
    channel : Connection
        To be polled; whatever ends the process closes it.
    folder : Path
        Of large arrays and of what was computed last.
    is_helper : bool
        Whether it is in the group of the worker that started it.
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
    is_helper: bool = False
    is_ready: bool = False
    is_busy: bool = False
    started: float = field(default_factory=time.monotonic)
    used: float = field(default_factory=time.monotonic)

    @property
    def is_alive(self) -> bool:
        """Whether the process has not ended; one that has is taken leave of by this."""
        return self.process.poll() is None

    def hand_over(self, task: Task) -> None:
        """Give the process a task; an OSError says that it has ended."""
        self.is_busy = True
        parcels.send(self.channel, task, self.folder)

    def told(self) -> Told:
        """Wait for what the process tells next; EOFError and OSError say that it has ended."""
        return cast(Told, parcels.receive(self.channel).unpacked())

    def kill(self) -> None:
        """End the process with all that it has started, whatever they do, and wait for that: some milliseconds."""
        if self.process.returncode is None:
            if sys.platform == "win32" or self.is_helper:
                self.process.kill()
            else:
                # One that has ended is not taken leave of yet, so that its group is still its own.
                with suppress(ProcessLookupError):
                    os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.channel.close()


def start(command: Sequence[str], folder: Path, *, is_helper: bool = False) -> WorkerProcess:
    """Start a worker process.

    Parameters
    ----------
    command : sequence of str
        Python and the start file.
    folder : Path
        Of large arrays and of what was computed last.
    is_helper : bool
        Whether a worker starts it, to which the folder belongs and with which it ends.

    Raises
    ------
    OSError
        If the system starts none.
    """
    ours, theirs = connection.Pipe()
    handle = theirs.fileno()
    with theirs:
        try:
            process = subprocess.Popen([*command, str(handle)], **_options(handle, is_helper))
        except OSError:
            ours.close()
            raise
    # One that ends at once is noticed when it is looked at.
    with suppress(OSError):
        ours.send((PACKAGE, str(ROOT), sys.path, str(folder), is_helper))
    return WorkerProcess(process, ours, folder, is_helper)


def _options(handle: int, is_helper: bool) -> dict[str, Any]:
    """Return how a process is started that has one end of a connection, and neither console nor output."""
    silent = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    if sys.platform != "win32":
        # A worker leads a group of its own, in which its helpers are, so that all of them end at once.
        return {**silent, "pass_fds": [handle], "process_group": None if is_helper else 0}
    os.set_handle_inheritable(handle, True)
    startup = subprocess.STARTUPINFO(lpAttributeList={"handle_list": [handle]})
    return {**silent, "startupinfo": startup, "creationflags": subprocess.CREATE_NO_WINDOW}
