"""Errors that nobody foresaw: a sentence for the user, and the traceback kept for the bug report."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy

from .sentences import tell
from .user_errors import refusals_told

OUT_OF_MEMORY = "There is not enough memory for this; try linear elements or a mesh with fewer faces."
PACKAGE = Path(__file__).parents[2]
# Where an error of another process keeps its traceback.
ELSEWHERE = "eigenparts_traceback"

_last: "Fault | None" = None


@dataclass(frozen=True)
class Fault:
    """An error that nobody foresaw.

    Attributes
    ----------
    sentence : str
        For the user.
    report : str
        The traceback, without folders of the user's.
    """

    sentence: str
    report: str


@contextmanager
def errors_told(operator: bpy.types.Operator) -> Iterator[None]:
    """Report every error in a sentence; those that nobody foresaw are kept for the bug report."""
    try:
        with refusals_told(operator):
            yield
    except Exception as error:
        # Whatever it is, the window must not show a traceback for it.
        tell(operator, "ERROR", remember(error).sentence)


def remember(error: Exception) -> Fault:
    """Keep an error for the bug report, in place of the one before."""
    global _last
    _last = Fault(_sentence(error), traceback_without_folders(error))
    return _last


def last() -> Fault | None:
    """Return the error that nobody foresaw, if the last job ended in one."""
    return _last


def forget() -> None:
    """Forget it, as a new job begins."""
    global _last
    _last = None


def traceback_without_folders(error: BaseException) -> str:
    """Return the traceback of an error, with places in this package or bare file names, and without its text.

    The text of an error may name a file or anything else that is nobody's business; only ours are known not to.
    """
    places = [
        f"{_place(frame.filename)}:{frame.lineno} in {frame.name}"
        for frame in traceback.extract_tb(error.__traceback__)
    ]
    cause = error.__cause__
    before = [traceback_without_folders(cause), "which led to"] if cause is not None else []
    elsewhere = getattr(error, ELSEWHERE, "")
    return "\n".join([*before, *places, elsewhere or type(error).__name__])


def keep_traceback(error: Exception, traceback: str) -> None:
    """Let an error of another process keep its traceback from there."""
    setattr(error, ELSEWHERE, traceback)


def _place(filename: str) -> str:
    path = Path(filename)
    return path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else path.name


def _sentence(error: Exception) -> str:
    if isinstance(error, MemoryError):
        return OUT_OF_MEMORY
    kind = type(error).__name__
    return f"Something went wrong that should not ({kind}). Copy Bug Report has the details; please report it."
