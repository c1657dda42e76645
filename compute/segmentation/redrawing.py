"""Branches as corrections need them: divided where a border is moved or drawn, and where faces were painted."""

from dataclasses import replace

import numpy as np

from ..mesh import Floats, Ints
from .branches import Branches, divided_branches
from .carrying import Divided, place_of
from .corrections import AWAY, LEVEL, MOVE, PAINT, SPLIT, Correction, Corrections
from .faces import FaceGraph
from .relief import Hill, Relief

# How many sides a border along the field has.
N_SIDES = 3


def redraw(
    divided: Divided,
    closing_heights: tuple[Floats, ...],
    items: tuple[Correction, ...],
    painted: Ints,
    relief: Relief,
    graph: FaceGraph,
) -> tuple[tuple[Branches, ...], Corrections]:
    """Divide branches so that every level with all corrections is a label for each of them.

    Parameters
    ----------
    divided : Divided
        With the branches of the analysis.
    closing_heights : tuple of (A,) float64
        For each tree, the value of the field at which each arc closes.
    items : tuple of Correction
    painted : (F,) int64
        The part each face was painted with, -1 elsewhere.
    relief : Relief
    graph : FaceGraph
    """
    sides = np.zeros((len(items), len(painted)), dtype=np.int64)
    code = painted + 1
    for row, item in enumerate(items):
        if item.kind in (SPLIT, MOVE):
            sides[row] = _sides(divided, closing_heights, items, item, relief)
            _, code = np.unique(code * N_SIDES + sides[row], return_inverse=True)
            code = code.reshape(-1)
    branches, face = divided_branches(divided.branches, code, graph)
    return branches, Corrections(items, sides[:, face], painted[face])


def undivided(branches: tuple[Branches, ...], items: tuple[Correction, ...]) -> Corrections:
    """Return corrections that need no branch to be divided."""
    n = len(branches[0].arc)
    return Corrections(items, np.full((len(items), n), AWAY), np.full(n, -1))


def needs_faces(items: tuple[Correction, ...]) -> bool:
    """Whether branches have to be divided for some corrections."""
    return any(item.kind in (SPLIT, MOVE, PAINT) for item in items)


def hill_of(
    divided: Divided, closing_heights: tuple[Floats, ...], items: tuple[Correction, ...], item: Correction
) -> tuple[int, Hill]:
    """Return the tree and the hill that the border of a correction lies on.

    Raises
    ------
    LookupError
        If its part is not cut off by the field.
    """
    origin = {made.other: made for made in items if made.kind == SPLIT}
    # A part that was split off lies on the hill of the part it was split from.
    while item.part in origin and origin[item.part] is not item:
        item = replace(origin.pop(item.part), kind=item.kind)
    branch_levels = tuple((other.part, int(other.value)) for other in items if other.kind == LEVEL)
    place = place_of(divided, item.part, item.level, item.mode, branch_levels)
    tree = divided.hierarchy.trees[place.tree]
    return place.tree, Hill(tree, place.arc, float(closing_heights[place.tree][place.arc]))


def level_of_border(hill: Hill, item: Correction, value_range: float) -> float:
    """Return the value of the field at the border of a correction."""
    inward = item.value if item.kind == SPLIT else -item.value
    return hill.border + hill.upward * inward * value_range


def _sides(
    divided: Divided,
    closing_heights: tuple[Floats, ...],
    items: tuple[Correction, ...],
    item: Correction,
    relief: Relief,
) -> Ints:
    try:
        tree, hill = hill_of(divided, closing_heights, items, item)
    except LookupError:
        return np.full(relief.n_faces, AWAY)
    level = level_of_border(hill, item, divided.hierarchy.value_range)
    return relief.sides(hill, divided.branches[tree], level)
