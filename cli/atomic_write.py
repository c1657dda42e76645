"""Write a file so that it is there as a whole or not at all, whatever happens meanwhile."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PREFIX = ".eigenparts-"
# Bytes that must still find room after a file was written: some exporters do not tell that they were cut short.
ROOM = 1 << 16


@contextmanager
def staged(target: Path) -> Iterator[Path]:
    """Yield a path to write to; what was written there, and beside it, takes its place when the block ends well."""
    discard(target)
    stage = _stage_of(target)
    stage.mkdir(parents=True)
    try:
        yield stage / target.name
        _check_room(stage)
        # The file itself comes last: whoever sees it finds what belongs to it.
        for part in sorted(stage.iterdir(), key=lambda part: part.name == target.name):
            os.replace(part, target.with_name(part.name))
    finally:
        discard(target)


def discard(target: Path) -> None:
    """Remove what a process left that was killed while it wrote this file."""
    shutil.rmtree(_stage_of(target), ignore_errors=True)


def _stage_of(target: Path) -> Path:
    return target.with_name(PREFIX + target.name)


def _check_room(stage: Path) -> None:
    """Raise an OSError if the disk is full."""
    with open(stage / "room", "wb") as probe:
        probe.write(bytes(ROOM))
        probe.flush()
        os.fsync(probe.fileno())
    (stage / "room").unlink()
