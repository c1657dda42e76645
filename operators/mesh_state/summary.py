"""The summary of an analysis for the panel; read at every redraw, so no large array is decoded for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .schema import DESCRIPTION, HIERARCHY, LEVEL, LONGEST_DESCRIPTION, MOST_LABELS, PARTS
from .serialization import unpacked_array

# Columns of the stored table of parts.
KINDS = {"id": "int64", "area": "float64", "n_triangles": "int64"}


@dataclass(frozen=True)
class Summary:
    """Field, level and parts of an analyzed mesh.

    Attributes
    ----------
    description : str
        Field and order, in words.
    level, n_levels : int
    parts : tuple of (id, area, faces)
        The body first, if it has faces; the area as a fraction of the whole.
    """

    description: str
    level: int
    n_levels: int
    parts: tuple[tuple[int, float, int], ...]

    @property
    def shares(self) -> dict[int, float]:
        """The area of each part as a fraction of the whole, by its number."""
        return {part: share for part, share, _ in self.parts}


def unpacked_summary(group: Any) -> Summary:
    """Return the summary in a state; raises one of ``UNREADABLE`` if it makes no sense."""
    parts = {name: unpacked_array(group[PARTS][name], dtype) for name, dtype in KINDS.items()}
    whole = parts["area"].sum()
    if not 0 < whole < np.inf or parts["area"].min() < 0:
        raise ValueError("area")
    share = parts["area"] / whole
    rows = tuple(zip(parts["id"].tolist(), share.tolist(), parts["n_triangles"].tolist(), strict=True))
    summary = Summary(group[DESCRIPTION], group[LEVEL], group[HIERARCHY]["n_levels"], rows)
    if not _makes_sense(summary):
        raise ValueError("summary")
    return summary


def _makes_sense(summary: Summary) -> bool:
    return (
        isinstance(summary.description, str)
        and len(summary.description) <= LONGEST_DESCRIPTION
        and isinstance(summary.level, int)
        and isinstance(summary.n_levels, int)
        and 0 <= summary.level < summary.n_levels
        and all(0 <= part < MOST_LABELS and n_faces >= 0 for part, _, n_faces in summary.parts)
    )
