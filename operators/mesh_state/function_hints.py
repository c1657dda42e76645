"""Which eigenfunctions suit a mesh: kept from an analysis that computed some, for the panel and for the report."""

from __future__ import annotations

from typing import Any

import bpy

from ... import compute
from .state import STATE

# In the state: for each judged function, the best first, its number and how many protrusions its parts hold.
HINTS = "function_hints"
MOST_SHOWN = 3


def store(mesh: bpy.types.Mesh, hints: tuple[compute.FunctionHint, ...]) -> None:
    """Keep what was judged; nothing is left where nothing was."""
    rows = [number for hint in hints for number in (hint.number, hint.n_held, hint.n_protrusions)]
    if rows:
        mesh[STATE][HINTS] = rows
    elif HINTS in mesh[STATE]:
        del mesh[STATE][HINTS]


def read(mesh: bpy.types.Mesh) -> list[tuple[int, int, int]]:
    """Return (number, protrusions held, protrusions of the shape) of each judged function, the best first."""
    state = mesh.get(STATE)
    rows: Any = state.get(HINTS) if hasattr(state, "to_dict") else None
    if getattr(rows, "typecode", None) != "i" or len(rows) % 3:
        return []
    return [tuple(rows[k : k + 3]) for k in range(0, len(rows), 3)]


def sentence(mesh: bpy.types.Mesh) -> str:
    """Return which function suits best; empty if it is not known."""
    hints = read(mesh)
    if not hints or hints[0][2] == 0:
        return ""
    number, n_held, n_protrusions = hints[0]
    return f"Eigenfunction {number} suits best: its parts hold {n_held} of {n_protrusions} protrusions."
