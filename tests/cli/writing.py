"""Commands and exporters that are quick, and calls that fail or end their process, to try what is written."""

import os
import sys
from collections.abc import Callable
from contextlib import contextmanager
from importlib import import_module

import bpy
import numpy as np

from compute import TriangleMesh
from tests.cli.files import add_object
from tests.shapes import star
from tools.extension import load_extension

# What the interpreter announces before it does it, and which of what it tells then are paths.
CHANGES = {"os.rename": (0, 1), "os.mkdir": (0,), "os.remove": (0,), "os.rmdir": (0,), "os.truncate": (0,)}
SHAPE = star(3, 1)
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT


def cli(name):
    """Return a module of the command line."""
    load_extension()
    return import_module(f"eigenparts.cli.{name}")


def line_of(process, beginning):
    """Wait for the line of a process that begins so, and return the rest of it; Blender may say something before."""
    line = next(line for line in process.stdout if line.startswith(beginning))
    return line.removeprefix(beginning).strip()


class Resize:
    """A command that leaves a file open with a star of another size for each level."""

    def __init__(self, level):
        self.settings = {"level": level}

    def open_and_process(self, path):
        """Leave the star open, which was not read from any file."""
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        star = add_object(TriangleMesh(SHAPE.vertices * self.settings["level"], SHAPE.triangles))
        parts = {"level": 0, "n_levels": 1, "parts": []}
        row = {"name": "star", **parts, "seconds": 0.0, "warnings": []}
        return cli("formats").OpenFile([star], {}), [row]


def save_as_text(path, file):
    """Stand in for an exporter: two files with the size of the star, and no call of Blender's that could be killed."""
    size = f"{size_of(file.objects[0]):.4g}"
    path.write_text(size)
    path.with_suffix(".mtl").write_text(size)


def size_of(obj):
    """Return the size of a star, as times that of the first."""
    longest = max((obj.matrix_world @ vertex.co).length for vertex in obj.data.vertices)
    return longest / np.linalg.norm(SHAPE.vertices, axis=1).max()


def run_job(job, level):
    """Do a file and return its report."""
    (report,) = cli("run_serial").run_in_this_process([job], Resize(level))
    return report


class Calls:
    """Count the calls that change files below a folder, and do something at one of them."""

    def __init__(self):
        self._below, self._last, self._do, self.n_calls = None, 0, None, 0
        sys.addaudithook(self._notice)

    @contextmanager
    def at(self, number: int, do: Callable[[], None], below):
        """Do something at the call of this number, counted from 1."""
        self._below, self._last, self._do, self.n_calls = str(below), number, do, 0
        try:
            yield self
        finally:
            self._below = None

    def _notice(self, event, arguments):
        if self._below is None or not any(self._below in str(path) for path in changed_by(event, arguments)):
            return
        self.n_calls += 1
        if self.n_calls == self._last:
            self._do()


def changed_by(event, arguments):
    """Return the paths that a call is about to change."""
    if event == "open":
        return arguments[:1] if arguments[2] & WRITES else ()
    return [arguments[number] for number in CHANGES.get(event, ())]
