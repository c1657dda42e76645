"""Cuts of a level: the part that is cut off at each arc."""

import numpy as np

from ...surface.mesh import Bools, Floats, Ints, sum_by
from ..hierarchy.arc_tree import ArcTree
from ..hierarchy.levels import Hierarchy
from ..hierarchy.nesting import nested_cuts, numbered
from .branches import Branches


def cut_arcs(
    hierarchy: Hierarchy,
    branches: tuple[Branches, ...],
    level: int,
    mode: str = "features",
    branch_levels: tuple[tuple[int, int], ...] = (),
) -> list[Ints]:
    """Return for each tree the part that is cut off at each arc on a level, 0 where nothing is.

    Parameters
    ----------
    branch_levels : tuple of (part, level)
        Parts inside which another level counts; their own borders stay.
    """
    is_cut = _cut_at_level(hierarchy, branches, level, mode)
    cuts = _numbered(hierarchy, is_cut)
    for part, own_level in branch_levels:
        inner = _cut_at_level(hierarchy, branches, min(own_level, hierarchy.n_levels - 1), mode)
        for number, tree in enumerate(hierarchy.trees):
            for arc in np.flatnonzero(cuts[number] == part).tolist():
                inside = tree.subtree(arc)
                inside[arc] = False
                is_cut[number] = np.where(inside, inner[number], is_cut[number])
        cuts = _numbered(hierarchy, is_cut)
    return cuts


def _numbered(hierarchy: Hierarchy, is_cut: list[Bools]) -> list[Ints]:
    return [numbered(tree, cut) for tree, cut in zip(hierarchy.trees, is_cut, strict=True)]


def _cut_at_level(hierarchy: Hierarchy, branches: tuple[Branches, ...], level: int, mode: str) -> list[Bools]:
    """Tell for each tree which arcs end a part."""
    if mode == "features":
        return [tree.is_feature(level) for tree in hierarchy.trees]
    default_level = hierarchy.default_level
    shares = [_shares_of_shells(tree, pieces) for tree, pieces in zip(hierarchy.trees, branches, strict=True)]
    return [nested_cuts(tree, level, default_level, share) for tree, share in zip(hierarchy.trees, shares, strict=True)]


def _shares_of_shells(tree: ArcTree, pieces: Branches) -> Floats:
    """Return the share (A,) of each arc in the area of its shell."""
    area = sum_by(pieces.arc, pieces.area, len(tree.part))
    whole = sum_by(tree.ground, area)[tree.ground]
    return area / np.where(whole > 0, whole, 1.0)
