"""Errors that nobody foresaw: a sentence for the user, and the traceback kept for the bug report."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy

from ...tasks.tracebacks import traceback_without_folders
from .sentences import tell
from .user_errors import refusals_told

OUT_OF_MEMORY = "There is not enough memory for this; try linear elements or a mesh with fewer faces."

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


def _sentence(error: Exception) -> str:
    if isinstance(error, MemoryError):
        return OUT_OF_MEMORY
    kind = type(error).__name__
    return f"Something went wrong that should not ({kind}). Copy Bug Report has the details; please report it."
