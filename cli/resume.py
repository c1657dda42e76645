"""Finished files, which need not be done again: the report kept with a result says what it was made of."""

import json
from collections.abc import Iterator
from hashlib import blake2b
from pathlib import Path
from typing import cast
from urllib.parse import unquote

from .jobs import Job
from .report import VERSION, Report, Settings, path_beside, without_version


def digest_of(path: Path) -> str:
    """Return a text that changes with the content of a file and of the files that belong to it."""
    digest = blake2b(digest_size=16)
    for part in (path, *_buffers(path)):
        with open(part, "rb") as stream:
            while block := stream.read(1 << 20):
                digest.update(block)
    return digest.hexdigest()


def finished_report(job: Job, settings: Settings) -> Report | None:
    """Return the report of a result that would come out the same again; None if there is no such result."""
    report = _read(path_beside(job.target))
    same = {"version": VERSION, "settings": settings}
    if report is None or "error" in report or any(report.get(name) != value for name, value in same.items()):
        return None
    try:
        is_same = job.target.stat().st_size > 0 and report.get("digest") == digest_of(job.path)
    except OSError:
        return None
    if not is_same:
        return None
    report = without_version(report)
    report["file"], report["output"], report["skipped"] = str(job.path), str(job.target), True
    return report


def is_result(path: Path) -> bool:
    """Whether a file is one that was written here: its report is beside it, or that of the file that it is made of."""
    if path_beside(path).is_file():
        return True
    source, _, rest = path.stem.rpartition("_parts")
    return bool(source) and not rest and path.with_name(source + path.suffix).is_file()


def _read(path: Path) -> Report | None:
    try:
        report = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    # Reports of results have objects; nothing else of what is read is trusted to be anything.
    is_report = isinstance(report, dict) and isinstance(report.get("objects"), list)
    return cast(Report, report) if is_report else None


def _buffers(path: Path) -> Iterator[Path]:
    """Yield the files that hold the numbers of a .gltf, which is only a table of contents."""
    if path.suffix.lower() != ".gltf":
        return
    try:
        names = [buffer.get("uri", "data:") for buffer in json.loads(path.read_text(encoding="utf-8"))["buffers"]]
    except (ValueError, KeyError, TypeError, AttributeError):
        return
    paths = (path.parent / unquote(name) for name in names if not name.startswith("data:"))
    yield from (path for path in paths if path.is_file())
