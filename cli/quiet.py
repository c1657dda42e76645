"""Keep Blender's own talk off the streams, so that they carry what we say and nothing else."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def blender_is_quiet() -> Iterator[None]:
    """Send what is written below Python's level to nowhere meanwhile."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [(stream, os.dup(stream)) for stream in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream, _ in kept:
            os.dup2(nowhere, stream)
        yield
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        for stream, duplicate in kept:
            os.dup2(duplicate, stream)
            os.close(duplicate)
        os.close(nowhere)
