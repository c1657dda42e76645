"""A process that does files: this command line once more, watched while it works."""

import json
import os
import signal
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path
from typing import cast

import bpy

from ...operators.messages.user_errors import MISSING_SCIPY
from ...tasks.refusals import Refusal
from ..reports.report import Report
from .verdict import ProcessEnd

# Bytes of what a process said last that are kept.
TAIL = 1 << 14
# Seconds that a process has to end after its last report.
GRACE = 20


class ChildProcess:
    """A process whose reports can be read while it works.

    What it says goes into files: these can be read without waiting on every system, and nobody waits for a pipe that a
    process of a process holds open.

    Parameters
    ----------
    command : list of str
    environment : dict
    folder : Path
        For what it says.
    """

    def __init__(self, command: list[str], environment: dict[str, str], folder: Path) -> None:
        name = str(time.monotonic_ns())
        self._paths = (folder / f"{name}.out", folder / f"{name}.err")
        with open(self._paths[0], "wb") as stdout, open(self._paths[1], "wb") as stderr:
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=stdout,
                stderr=stderr,
                env=environment,
                # Ctrl C is for the process that the user started; it ends the others with all that they started.
                start_new_session=True,
            )
        self._n_read = 0
        self._last_report = time.monotonic()

    def poll(self) -> tuple[list[Report], ProcessEnd | None]:
        """Return the reports since the last call, and how the process ended if it did."""
        # In this order, so that nothing is missed that it says last.
        code = self._process.poll()
        reports = self._read()
        if reports:
            self._last_report = time.monotonic()
        return reports, None if code is None else ProcessEnd(code, self._last_errors())

    @property
    def seconds(self) -> float:
        """How long it has worked on its present file."""
        return time.monotonic() - self._last_report

    def kill(self) -> None:
        """End it with all that it started."""
        try:
            if sys.platform == "win32":
                self._process.kill()
            else:
                os.killpg(self._process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self._process.wait()
        for path in self._paths:
            path.unlink(missing_ok=True)

    def _read(self) -> list[Report]:
        with open(self._paths[0], "rb") as stream:
            stream.seek(self._n_read)
            # A line is read when it is there as a whole.
            lines, end, _ = stream.read().rpartition(b"\n")
        self._n_read += len(lines) + len(end)
        return reports_in(lines.decode("utf-8", errors="replace").splitlines())

    def _last_errors(self) -> str:
        with open(self._paths[1], "rb") as stream:
            stream.seek(max(0, self._paths[1].stat().st_size - TAIL))
            return stream.read().decode("utf-8", errors="replace")


def own_command() -> list[str]:
    """Return what starts this command line on this machine: the application, or Python with Blender as a module."""
    if bpy.app.binary_path:
        return [bpy.app.binary_path, "--background", "--command", "eigenparts"]
    scipy = find_spec("scipy")
    if scipy is None or scipy.origin is None:
        raise Refusal(MISSING_SCIPY)
    folder_of_scipy = Path(scipy.origin).parents[1]
    return [sys.executable, "-P", str(Path(__file__).parents[1] / "launch.py"), str(folder_of_scipy)]


def reports_in(lines: list[str]) -> list[Report]:
    """Return the reports among what a process has said; Blender says other things there."""
    return [
        cast(Report, json.loads(line))
        for line in lines
        if line.startswith('{"version"') and line.rstrip().endswith("}")
    ]
