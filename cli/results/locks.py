"""Locks between processes: held by what a process has open, so that they end with it, whatever ends it."""

import errno
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

# Seconds to wait for another process, which holds a folder while it moves one result, and between two looks.
PATIENCE = 60.0
PAUSE = 0.01
# Windows locks bytes, which nobody else can read then, and cannot open folders; so a byte behind the end, and a file.
BYTE = 1 << 30
FILE_OF_LOCK = ".eigenparts-lock"


def try_lock(descriptor: int) -> bool:
    """Lock what is open, until it is closed; False if another process has.

    Raises
    ------
    OSError
        If the file system has no locks.
    """
    try:
        if sys.platform == "win32":
            os.lseek(descriptor, BYTE, os.SEEK_SET)
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    return True


@contextmanager
def folder_lock(folder: Path) -> Iterator[None]:
    """Keep other processes out of a folder that exists; where its file system has no locks, go on without.

    Raises
    ------
    OSError
        If another process holds it for too long.
    """
    descriptor = _locked(folder)
    try:
        yield
    finally:
        if descriptor is not None:
            os.close(descriptor)


def _locked(folder: Path) -> int | None:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            if (descriptor := _try_folder(folder)) is not None:
                return descriptor
        except OSError:
            return None
        time.sleep(PAUSE)
    raise TimeoutError(errno.ETIMEDOUT, "another run has been busy there for too long; wait for it or end it", folder)


def _try_folder(folder: Path) -> int | None:
    """Return what holds the lock of a folder, None if another process has it."""
    if sys.platform == "win32":
        try:
            # Windows removes it when its process ends, so that it is there as long as it is held.
            return os.open(folder / FILE_OF_LOCK, os.O_CREAT | os.O_EXCL | os.O_RDWR | os.O_TEMPORARY)
        except (FileExistsError, PermissionError):
            return None
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        is_locked = try_lock(descriptor)
    except OSError:
        os.close(descriptor)
        raise
    if not is_locked:
        os.close(descriptor)
    return descriptor if is_locked else None
