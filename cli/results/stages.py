"""Stages: folders in which a result is written until it is whole, beside the place that it will take.

A stage holds a file that says so and that its process keeps locked. So those of processes that are gone can be told
from those of others that write into the same folder at the same time, and both from the user's folders.
"""

import errno
import os
import secrets
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from hashlib import blake2b
from pathlib import Path

from .digests import digest_there
from .locks import folder_lock, try_lock

PREFIX = ".eigenparts-"
MARKER = ".eigenparts-stage"
# Bytes that must still find room after a file was written: some exporters do not tell that they were cut short.
ROOM = 1 << 16


@contextmanager
def stage_in(folder: Path) -> Iterator[Path]:
    """Yield a new folder inside one; what is still in it when the block ends is removed with it."""
    folder.mkdir(parents=True, exist_ok=True)
    stage = folder / _signed(secrets.token_hex(4))
    marker = None
    try:
        # A stage that is not locked yet looks as if its process were gone.
        with folder_lock(folder):
            stage.mkdir()
            marker = os.open(stage / MARKER, os.O_CREAT | os.O_RDWR)
            with suppress(OSError):
                try_lock(marker)
        yield stage
    finally:
        if marker is not None:
            os.close(marker)
        shutil.rmtree(stage, ignore_errors=True)


def files_in(stage: Path) -> list[Path]:
    """Return what was written into a stage."""
    return [path for path in stage.iterdir() if path.name != MARKER]


def remove_stale(folder: Path) -> None:
    """Remove what processes left in a folder that ended while they wrote."""
    with suppress(OSError), folder_lock(folder):
        for stage in folder.glob(f"{PREFIX}*"):
            with suppress(OSError):
                _remove_if_stale(stage)


def check_room(stage: Path) -> None:
    """Raise an OSError if the disk is full, or a file as large as a file may be here."""
    largest = max((path.stat().st_size for path in files_in(stage)), default=0)
    with open(stage / "room", "wb") as probe:
        probe.seek(largest)
        probe.write(bytes(ROOM))
        probe.flush()
        os.fsync(probe.fileno())
    (stage / "room").unlink()


def write_surely(write: Callable[[], object], path: Path) -> None:
    """Write a file, and what belongs to it, with an exporter that does not tell what it could not write.

    It is written twice, since no accident happens twice in the same way, and a full disk is noticed otherwise.
    """
    write()
    first = _digests_in(path.parent)
    write()
    if first != _digests_in(path.parent):
        raise OSError(errno.EIO, "it could not be written as a whole", path.name)


def _digests_in(stage: Path) -> dict[str, str | None]:
    return {path.name: digest_there(path) for path in files_in(stage)}


def _remove_if_stale(stage: Path) -> None:
    """Remove a stage that nobody holds; an OSError says that it is none, or that there is no telling."""
    if stage.is_symlink():
        return
    if stage.name == _signed(stage.name[len(PREFIX) :][:8]) and not any(stage.iterdir()):
        # Its process ended before it said what the folder is.
        stage.rmdir()
        return
    marker = os.open(stage / MARKER, os.O_RDWR)
    try:
        is_stale = try_lock(marker)
    finally:
        os.close(marker)
    if is_stale:
        shutil.rmtree(stage, ignore_errors=True)


def _signed(token: str) -> str:
    """Return the name of a stage, which is no name that anybody else thinks of."""
    return f"{PREFIX}{token}{blake2b(token.encode(), digest_size=4).hexdigest()}"
