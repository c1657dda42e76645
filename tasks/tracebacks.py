"""Tracebacks for bug reports: places in the code, and nothing that is the user's."""

import traceback
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
# Where an error of another process keeps its traceback.
ELSEWHERE = "eigenparts_traceback"


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
