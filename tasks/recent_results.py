"""Results computed last, kept while Blender runs: trying another matching then needs no new analysis.

Nothing depends on it: what is not here any more is computed again. The worker process keeps them in a folder, too, for
the worker that comes after one that was ended.
"""

from __future__ import annotations

import hashlib
import os
import pickle
from collections import OrderedDict
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Generic, TypeVar, cast

import numpy as np

Value = TypeVar("Value")


# Bytes of the files of one kind.
LARGEST_FOLDER = 2_000_000_000

_folder: Path | None = None


def keep_in(folder: Path) -> None:
    """From now on keep results in a folder, too, and find those that are there."""
    global _folder
    _folder = folder


class Recent(Generic[Value]):
    """Values by key, the latest ones up to a total size.

    Parameters
    ----------
    name : str
        What they are; that of their folder.
    largest_size : int
    """

    def __init__(self, name: str, largest_size: int) -> None:
        self._name, self._largest_size = name, largest_size
        self._kept: OrderedDict[str, tuple[Value, int]] = OrderedDict()

    def get(self, key: str) -> Value | None:
        """Return a value, None if it is not here any more."""
        if key not in self._kept:
            self._read(key)
        if key not in self._kept:
            return None
        self._kept.move_to_end(key)
        return self._kept[key][0]

    def put(self, key: str, value: Value, size: int) -> None:
        """Keep a value in place of the oldest ones."""
        self._keep(key, value, size)
        folder = self._own_folder()
        if folder is None:
            return
        # A full disk, or an object that only the memory holds, keeps nobody from the result.
        with suppress(OSError, MemoryError, pickle.PicklingError):
            folder.mkdir(parents=True, exist_ok=True)
            # Two processes may keep the same.
            started = folder / f"{key}.{os.getpid()}.started"
            with started.open("wb") as file:
                pickle.dump((value, size), file, protocol=5)
            started.replace(folder / key)
            _remove_oldest(folder)

    def _keep(self, key: str, value: Value, size: int) -> None:
        self._kept[key] = value, size
        self._kept.move_to_end(key)
        while sum(size for _, size in self._kept.values()) > self._largest_size:
            self._kept.popitem(last=False)

    def _read(self, key: str) -> None:
        """Take in what a worker before this one has kept."""
        folder = self._own_folder()
        with suppress(OSError, EOFError, MemoryError, pickle.UnpicklingError):
            if folder is not None and (folder / key).exists():
                self._keep(key, *cast(tuple[Value, int], pickle.loads((folder / key).read_bytes())))

    def _own_folder(self) -> Path | None:
        return None if _folder is None else _folder / self._name


def _remove_oldest(folder: Path) -> None:
    """Remove files that were kept before the latest ones, which have `LARGEST_FOLDER` bytes together at most."""
    n_bytes = 0
    for path in sorted(folder.iterdir(), key=lambda path: path.stat().st_mtime_ns, reverse=True):
        n_bytes += path.stat().st_size
        if n_bytes > LARGEST_FOLDER:
            path.unlink()


def key_of(values: Iterable[object]) -> str:
    """Return a key for arrays, numbers and texts: equal for equal ones."""
    digest = hashlib.blake2b(digest_size=16)
    for value in values:
        shown = value.shape if isinstance(value, np.ndarray) else repr(value)
        digest.update(f"{type(value).__name__} {shown};".encode())
        if isinstance(value, np.ndarray):
            digest.update(np.ascontiguousarray(value).tobytes())
    return digest.hexdigest()
