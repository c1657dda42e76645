"""Whether memory grows: small meshes in one batch, and levels that are changed and undone.

usage: python -m benchmarks.load [--meshes N] [--changes N]
"""

import argparse
import contextlib
import io
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
import psutil

from examples import humanoid
from examples.blender import add_posed_mesh
from tests.shapes import star
from tools.extension import load_extension

MEGABYTE = 1 << 20
# Rows of each table.
N_ROWS = 10


def main(arguments: list[str]) -> int:
    """Print both tables in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--meshes", type=int, default=1000)
    parser.add_argument("--changes", type=int, default=100)
    options = parser.parse_args(arguments)
    extension = load_extension()
    sys.stdout.write(f"bpy {bpy.app.version_string}, numpy {np.__version__}\n\n")
    _print_table("files", "a file", _batch(extension, options.meshes))
    extension.register()
    _print_table("changes of the level", "a change", _change_levels(options.changes))
    _print_table("undos", "an undo", _undo(options.changes))
    return 0


def _print_table(what: str, each: str, rows: Iterator[tuple[int, float]]) -> None:
    sys.stdout.write(f"| {what} | memory | seconds {each} |\n|---|---|---|\n")
    for number, seconds in rows:
        memory = psutil.Process().memory_info().rss / MEGABYTE
        sys.stdout.write(f"| {number} | {memory:.1f} MB | {seconds:.3f} |\n")
        sys.stdout.flush()
    sys.stdout.write("\n")


def _batch(extension: object, n_meshes: int) -> Iterator[tuple[int, float]]:
    """Divide folders of small stars with the command line, all in this process."""
    n_a_row = n_meshes // N_ROWS
    with tempfile.TemporaryDirectory() as folder:
        for row in range(N_ROWS):
            start = row * n_a_row
            files = Path(folder) / str(row)
            files.mkdir()
            for number in range(start, start + n_a_row):
                _write_star(number, files / f"star{number}.off")
            begin = time.perf_counter()
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                if extension.cli.main(["batch", str(files)]) != 0:
                    raise RuntimeError("a file failed")
            yield start + n_a_row, (time.perf_counter() - begin) / n_a_row


def _write_star(number: int, path: Path) -> None:
    mesh = star(2 + number % 5, 2, length=1.0 + number % 7 / 10)
    lines = [" ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [" ".join(map(str, [3, *row])) for row in mesh.triangles.tolist()]
    path.write_text(f"OFF\n{len(mesh.vertices)} {len(mesh.triangles)} 0\n" + "\n".join(lines) + "\n")


def _change_levels(n_changes: int) -> Iterator[tuple[int, float]]:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.context.preferences.edit.undo_steps = 2 * n_changes
    bpy.context.view_layer.objects.active = add_posed_mesh(humanoid(10_000))
    bpy.ops.eigenparts.analyze()
    bpy.ops.ed.undo_push(message="Analyze")
    n_levels = bpy.context.object.data["eigenparts_state"]["hierarchy"]["n_levels"]
    yield from _timed(n_changes, lambda number: _change_level(7 * number % n_levels))


def _change_level(level: int) -> None:
    bpy.ops.eigenparts.segment(level=level)
    bpy.ops.ed.undo_push(message="Segment")


def _undo(n_undos: int) -> Iterator[tuple[int, float]]:
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        yield from _timed(n_undos, lambda number: bpy.ops.ed.undo())


def _timed(n_times: int, step: object) -> Iterator[tuple[int, float]]:
    for stop in range(n_times // N_ROWS, n_times + 1, n_times // N_ROWS):
        begin = time.perf_counter()
        for number in range(stop - n_times // N_ROWS, stop):
            step(number)
        yield stop, (time.perf_counter() - begin) / (n_times // N_ROWS)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
