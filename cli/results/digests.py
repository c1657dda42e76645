"""Digests: short texts that change with the content of files."""

import json
import stat
from collections.abc import Iterator
from hashlib import blake2b
from pathlib import Path
from urllib.parse import unquote

# Of what is no file: a folder, a link, a pipe.
NO_FILE = ""


def digest_of(source: Path) -> str:
    """Return the digest of a file together with the files that belong to it."""
    return _digest([source, *_buffers(source)])


def digest_there(path: Path) -> str | None:
    """Return the digest of what has a name on disk, None if nothing has; links are not followed."""
    try:
        mode = path.lstat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None
    return _digest([path]) if stat.S_ISREG(mode) else NO_FILE


def _digest(paths: list[Path]) -> str:
    digest = blake2b(digest_size=16)
    for path in paths:
        with open(path, "rb") as stream:
            while block := stream.read(1 << 20):
                digest.update(block)
    return digest.hexdigest()


def _buffers(path: Path) -> Iterator[Path]:
    """Yield the files that hold the numbers of a .gltf, which is only a table of contents and may say anything."""
    if path.suffix.lower() != ".gltf":
        return
    try:
        names = [buffer.get("uri") for buffer in json.loads(path.read_text(encoding="utf-8"))["buffers"]]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return
    for name in names:
        if isinstance(name, str) and not name.startswith("data:") and _is_file(buffer := path.parent / unquote(name)):
            yield buffer


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        # Names that are too long, for one.
        return False
