"""Write results to a disk that is full: ``python -m tests.cli.full_disk FOLDER``, where FOLDER is a disk of its own.

Prints a line of JSON for each format and room: what was told, the levels that count as finished, and whether the next
run, with room again, is.
"""

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.cli.writing import cli, run_job

ROOMS = (0, 1 << 12, 1 << 14, 1 << 15, (1 << 16) + (1 << 12))


def main(folder: Path) -> None:
    """Try all formats and rooms."""
    for suffix in (".off", ".obj", ".ply", ".glb", ".fbx", ".blend"):
        source = folder / f"star{suffix}"
        source.write_text("the source")
        job = cli("jobs").Job(source, folder / f"star_parts{suffix}")
        for room in ROOMS:
            run_job(job, 1)
            with filled(folder / "filler", room):
                report = run_job(job, 2)
                finished = levels_finished(job)
            again = run_job(job, 2)
            print("FULL", json.dumps([suffix, report.get("error", ""), finished, again.get("error", "")]), flush=True)


def levels_finished(job) -> list[int]:
    """Return the levels for which the result counts as finished."""
    return [level for level in (1, 2) if cli("results.resume").finished_report(job, {"level": level})]


@contextmanager
def filled(filler: Path, room: int) -> Iterator[None]:
    """Leave so many bytes of room on a disk."""
    status = os.statvfs(filler.parent)
    filler.write_bytes(bytes(max(0, status.f_bavail * status.f_frsize - room)))
    yield
    filler.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
    sys.stdout.flush()
    os._exit(0)
