"""Keep Blender's own talk off the streams, so that they carry what we say and nothing else."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout

from .supervision import is_supervised


@contextmanager
def blender_is_quiet() -> Iterator[None]:
    """Send what Blender writes meanwhile to nowhere, be it through Python or below it.

    What is written to stderr below Python is kept for a process that waits for this one: it may be why this one ends.
    """
    flush_streams()
    kept = [(stream, os.dup(stream)) for stream in ((1,) if is_supervised() else (1, 2))]
    try:
        with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
            for stream, _ in kept:
                os.dup2(nowhere.fileno(), stream)
            yield
    finally:
        flush_streams()
        for stream, duplicate in kept:
            os.dup2(duplicate, stream)
            os.close(duplicate)


def flush_streams() -> None:
    """Write out what Python and Blender's own code still hold back."""
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL("ucrtbase" if sys.platform == "win32" else None).fflush(None)
