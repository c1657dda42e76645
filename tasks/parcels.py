"""Values on their way between Blender and its worker: through the connection, and large arrays through mapped files.

Only the two processes of one Blender write what is read here; nothing of a file of the user's is ever unpickled.
"""

from __future__ import annotations

import mmap
import pickle
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

# Bytes of an array from which on it travels through a file; its pages are then loaded as they are used.
LARGE = 64_000_000


@dataclass(frozen=True, eq=False)
class Parcel:
    """A value that has arrived: its bytes, and the files of large arrays."""

    body: bytes
    paths: tuple[str, ...]

    def unpacked(self) -> Any:
        """Return the value; arrays that came in files can be changed, which changes no file."""
        return pickle.loads(self.body, buffers=[_mapped(Path(path)) for path in self.paths])


def send(channel: Connection, value: Any, folder: Path) -> None:
    """Send a value; arrays of more than `LARGE` bytes become files in a folder, which the receiver removes."""
    paths: list[str] = []

    def stays(buffer: pickle.PickleBuffer) -> bool:
        raw = buffer.raw()
        if raw.nbytes <= LARGE:
            return True
        paths.append(_written(raw, folder))
        return False

    body = pickle.dumps(value, protocol=5, buffer_callback=stays)
    channel.send(paths)
    channel.send_bytes(body)


def receive(channel: Connection) -> Parcel:
    """Wait for a value and return it as it came."""
    paths = channel.recv()
    return Parcel(channel.recv_bytes(), tuple(paths))


def _written(raw: memoryview, folder: Path) -> str:
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=folder, prefix="array-", delete=False) as file:
        file.write(raw)
    return file.name


def _mapped(path: Path) -> mmap.mmap:
    with path.open("rb") as file:
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY)
    # Windows keeps a mapped file; it goes with the folder.
    with suppress(OSError):
        path.unlink()
    return mapped
