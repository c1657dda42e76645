"""The refusal of a damaged file: where, what is wrong, and what to do."""

from ...tasks.refusals import Refusal

MEND = "copy it here again, or export it again from the program that made it."


def damaged(problem: str) -> Refusal:
    """Return the refusal of a file for something that is wrong in it, such as "line 3: there is no number"."""
    return Refusal(f"{problem}; {MEND}")


def cut_short(where: str) -> Refusal:
    """Return the refusal of a file that is not there as a whole."""
    return damaged(f"{where}: the file is cut short")
