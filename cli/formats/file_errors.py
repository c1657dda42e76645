"""Sentences for what goes wrong with a file: where it is damaged, what is wrong, what to do."""

import re
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ...compute.errors import EngineError
from ...tasks.refusals import Refusal
from ..processes.verdict import MEMORY_WORDS, MORE_MEMORY, NO_MEMORY
from ..results.stages import PREFIX
from .damage import damaged

# What the errors of Blender's operators begin with.
OPERATOR = "Error:"


@contextmanager
def reading_errors_told(path: Path, damage_of: Callable[[Path], Refusal] | None) -> Iterator[None]:
    """Turn all that goes wrong while a file is read into a Refusal that says where and what."""
    try:
        yield
    except (Refusal, EngineError, MemoryError, OSError):
        raise
    except Exception as error:
        # Readers raise whatever their files lead them to.
        if any(word in str(error).lower() for word in MEMORY_WORDS):
            raise MemoryError from error
        raise (damage_of or _not_understood)(path) from error


def problem_of(error: Exception) -> str:
    """Return one line about what went wrong with a file."""
    if isinstance(error, Refusal | EngineError):
        return str(error)
    if isinstance(error, OSError) and error.strerror:
        return f"{error.strerror}: {_as_named(str(error.filename))}." if error.filename else f"{error.strerror}."
    if isinstance(error, MemoryError):
        return NO_MEMORY + MORE_MEMORY
    if isinstance(error, RuntimeError) and str(error).startswith(OPERATOR):
        return f"Blender could not write it: {reason_of(error)}."
    place = traceback.extract_tb(error.__traceback__)[-1:]
    where = f" ({Path(place[0].filename).name}, line {place[0].lineno})" if place else ""
    return f"something went wrong that should not{where}; please report it, with the file if you can."


def reason_of(error: RuntimeError) -> str:
    """Return what an operator of Blender's said, without labels, and without the traceback of one in Python."""
    said = str(error)
    if number := re.search(r"\[Errno \d+\] ([^:\n]*)", said):
        return number[1].strip()
    if "Traceback" in said:
        return "this scene is more than its writer understands; take another format, such as .blend"
    return _as_named(said.splitlines()[0].removeprefix(OPERATOR).strip().rstrip("."))


def _as_named(path: str) -> str:
    """Return a path as the user knows it, without the folder in which files are written at first."""
    return re.sub(rf"{re.escape(PREFIX)}[^/\\]*[/\\]", "", path)


def _not_understood(path: Path) -> Refusal:
    return damaged(f"what is in the {path.suffix.lower()} file does not fit together, and Blender cannot read it")
