"""The eigenfunctions that suit a mesh: kept from an analysis that computed some, for the panel and for the report."""

from __future__ import annotations

from typing import Any

from ... import compute
from .schema import FUNCTION_HINTS

MOST_SHOWN = 3


def packed_hints(hints: tuple[compute.FunctionHint, ...]) -> dict[str, Any]:
    """Return what was judged as a list of the state; nothing where nothing was."""
    numbers = [number for row in rows_of(hints) for number in row]
    return {FUNCTION_HINTS: numbers} if numbers else {}


def rows_of(hints: tuple[compute.FunctionHint, ...]) -> list[tuple[int, int, int]]:
    """Return (number, protrusions held, protrusions of the shape) of each judged function, the best first."""
    return [(hint.number, hint.n_held, hint.n_protrusions) for hint in hints]


def unpacked_hints(rows: Any) -> list[tuple[int, int, int]]:
    """Return (number, protrusions held, protrusions of the shape) of each judged function, the best first."""
    if getattr(rows, "typecode", None) != "i" or len(rows) % 3:
        return []
    return [(rows[k], rows[k + 1], rows[k + 2]) for k in range(0, len(rows), 3)]


def sentence(hints: list[tuple[int, int, int]]) -> str:
    """Return which function suits best; empty if it is not known."""
    if not hints or hints[0][2] == 0:
        return ""
    number, n_held, n_protrusions = hints[0]
    return f"Eigenfunction {number} suits best: its parts hold {n_held} of {n_protrusions} protrusions."
