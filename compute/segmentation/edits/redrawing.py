"""Part trees as corrections need them: branches divided at borders that are moved or drawn, and at painted faces."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import isnan

import numpy as np

from ...surface.mesh import Bools, Ints
from ..borders.edge_profile import EdgeProfile
from ..borders.level_set_borders import Crossings, cross_edges
from ..faces.branches import divided_branches
from ..faces.face_graph import FaceGraph
from ..faces.part_tree import PartTree
from ..hierarchy.arc_tree import ArcTree, flat_tree
from .corrections import AWAY, LEVEL, MERGE, MOVE, PAINT, SPLIT, Correction, Corrections
from .part_tracking import place_of
from .relief import Hill, Relief

# How many sides a border along the field has.
N_SIDES = 3


@dataclass(frozen=True, eq=False)
class Drawn:
    """A border along the field that a correction has put where it is.

    Attributes
    ----------
    part : int
        The part it cuts off.
    hill : Hill
    level : float
        The value of the field at the border.
    is_beyond : (V,) bool
        Which vertices lie in the part.
    """

    part: int
    hill: Hill
    level: float
    is_beyond: Bools


def redraw(
    part_tree: PartTree, items: tuple[Correction, ...], painted: Ints, relief: Relief, graph: FaceGraph
) -> tuple[PartTree, Corrections]:
    """Divide branches so that every level with all corrections is a label for each of them.

    Parameters
    ----------
    part_tree : PartTree
        Of the analysis.
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
            sides[row] = _sides(part_tree, items, item, relief)
            _, code = np.unique(code * N_SIDES + sides[row], return_inverse=True)
            code = code.reshape(-1)
    branches, face = divided_branches(part_tree.branches, code, graph)
    return replace(part_tree, branches=branches), Corrections(items, sides[:, face], painted[face])


def undivided(part_tree: PartTree, items: tuple[Correction, ...]) -> Corrections:
    """Return corrections that need no branch to be divided."""
    n = len(part_tree.branches[0].arc)
    return Corrections(items, np.full((len(items), n), AWAY), np.full(n, -1))


def needs_faces(items: tuple[Correction, ...]) -> bool:
    """Return whether branches have to be divided for some corrections."""
    return any(item.kind in (SPLIT, MOVE, PAINT) for item in items)


def hill_of(part_tree: PartTree, items: tuple[Correction, ...], item: Correction) -> Hill:
    """Return the part whose border a correction moves or draws anew.

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
    place = place_of(part_tree, item.part, item.level, item.mode, branch_levels)
    border = float(part_tree.closing_heights[place.tree][place.arc])
    if isnan(border):
        # A whole shell ends nowhere.
        raise LookupError(item.part)
    return Hill(part_tree.trees[place.tree].is_of_maxima, border, part_tree.faces_inside(place.tree, place.arc))


def level_of_border(hill: Hill, item: Correction, value_range: float) -> float:
    """Return the value of the field at the border of a correction."""
    inward = item.value if item.kind == SPLIT else -item.value
    return hill.border + hill.upward * inward * value_range


def _sides(part_tree: PartTree, items: tuple[Correction, ...], item: Correction, relief: Relief) -> Ints:
    try:
        hill = hill_of(part_tree, items, item)
    except LookupError:
        return np.full(relief.n_faces, AWAY)
    return relief.sides(hill, level_of_border(hill, item, part_tree.hierarchy.value_range))


def corrected_crossings(
    profile: EdgeProfile, part_tree: PartTree, cuts: list[Ints], drawn: tuple[Drawn, ...], joined: Mapping[int, int]
) -> tuple[EdgeProfile, Crossings]:
    """Find where the borders of parts cross edges after corrections.

    Parameters
    ----------
    profile : EdgeProfile
    part_tree : PartTree
    cuts : list of (A,) int64
        For each tree, the part that is cut off at each arc.
    drawn : tuple of Drawn
        Borders that were moved or drawn.
    joined : mapping of int to int
        The parts that became pieces of others.

    Returns
    -------
    profile : EdgeProfile
        With the vertices on a tree of its own for each drawn border, as the arcs of the crossings are.
    crossings : Crossings
    """
    moved = {border.part for border in drawn}
    kept = [
        np.where(np.isin(cut, list(moved)) | _is_joined(tree, cut, joined), 0, cut)
        for tree, cut in zip(part_tree.trees, cuts, strict=True)
    ]
    is_known = profile.arcs[0] >= 0
    # Each drawn border is the end of a tree of two arcs: what lies beyond it, and the rest.
    trees = (*part_tree.trees, *(flat_tree(1, border.hill.is_of_maxima) for border in drawn))
    heights = (*part_tree.closing_heights, *(np.array([border.level, np.nan]) for border in drawn))
    arcs = tuple(np.where(is_known, np.where(border.is_beyond, 0, 1), -1).astype(np.int32) for border in drawn)
    extended = replace(profile, arcs=(*profile.arcs, *arcs))
    ends = [*kept, *(np.array([border.part, 0]) for border in drawn)]
    return extended, cross_edges(extended, trees, heights, ends)


def drawn_borders(
    part_tree: PartTree, corrections: Corrections, resting: tuple[int, ...], relief: Relief
) -> tuple[Drawn, ...]:
    """Return the borders along the field that corrections have put where they are; those that rest are left out."""
    drawn = []
    for row, item in enumerate(corrections.items):
        if item.kind in (SPLIT, MOVE) and row not in resting:
            hill = hill_of(part_tree, corrections.items, item)
            level = level_of_border(hill, item, part_tree.hierarchy.value_range)
            is_beyond = relief.reach(hill) & (hill.upward * relief.heights > hill.upward * level)
            drawn.append(Drawn(item.other if item.kind == SPLIT else item.part, hill, level, is_beyond))
    return tuple(drawn)


def joined_parts(corrections: Corrections, resting: tuple[int, ...]) -> dict[int, int]:
    """Return the parts that became pieces of others."""
    return {
        item.part: item.other for row, item in enumerate(corrections.items) if item.kind == MERGE and row not in resting
    }


def _is_joined(tree: ArcTree, cut: Ints, joined: Mapping[int, int]) -> Bools:
    """Mask (A,) of the cut arcs that have the same part on both sides."""
    outside = np.where(tree.is_root, 0, tree.spread(cut)[tree.parent])
    whole = [(_end(part, joined), _end(around, joined)) for part, around in zip(cut, outside, strict=True)]
    return np.array([part == around for part, around in whole], dtype=bool)


def _end(part: int, joined: Mapping[int, int]) -> int:
    """Return the part that one became, through all joins."""
    for _ in range(len(joined)):
        part = joined.get(int(part), int(part))
    return int(part)
