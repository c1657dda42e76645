"""The end of a Python that has Blender as a module, which must come by itself whatever was loaded."""

import atexit
import os
import shutil
import typing
from functools import cache
from pathlib import Path
from typing import NoReturn

import bpy

from .suppress_output import flush_streams

# What Blender calls the folder that each of its sessions has for temporary files.
SESSION_FOLDER = "blender_"


@cache
def let_python_end() -> None:
    """Make sure that Python ends after a script that has Blender as a module.

    Blender stops its threads when the module ``bpy`` is freed. Where a class is left that knows it, it is not freed,
    and Blender 4.5 then waits at the end for a thread of its own for ever. `typing` remembers classes, among them
    those of the glTF add-on, and libraries such as scipy.optimize keep alive what they refer to.
    """
    atexit.register(_forget_types)


def end_process(code: int) -> NoReturn:
    """End this process at once, with all that was said written out and nothing left behind."""
    flush_streams()
    folder = Path(bpy.app.tempdir)
    # Blender takes the folder of all programs where it could not make one of its own.
    if folder.name.startswith(SESSION_FOLDER):
        shutil.rmtree(folder, ignore_errors=True)
    os._exit(code)


def _forget_types() -> None:
    # As Python's own tests do; there is no public way.
    for forget in getattr(typing, "_cleanups", ()):
        forget()
