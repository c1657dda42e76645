"""Processes that another one waits for, and that end with it."""

import ctypes
import os
import signal
import sys

# Set in the environment of such a process: the number of the one that waits for it.
SUPERVISED = "EIGENPARTS_SUPERVISED"
# Of Linux's prctl: the signal that a process gets when the one that started it ends.
SET_PARENT_DEATH_SIGNAL = 1


def is_supervised() -> bool:
    """Whether this process does files for another one, which reads what it says."""
    return SUPERVISED in os.environ


def end_with_parent() -> None:
    """Have the system end this process when the one that started it ends, where it can (Linux)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
        # It may have ended while this one was starting.
        if os.getppid() != int(os.environ[SUPERVISED]):
            os._exit(1)
