"""Levels overlaid: which cuts between features are worth a part of their own."""

import numpy as np

from ..mesh import Bools, Floats
from .arc_tree import ArcTree
from .necks import LEAST_HEIGHT

# An inner part is worth keeping if its border is a neck: shorter than this fraction of its longest level set.
NECK = 0.7
# And if it has at least this fraction of the area of the whole.
LEAST_AREA = 0.02
# A feature is worth a part if it stands out: all its level sets have less than this length²/area. A hemisphere has
# 2 pi, a hemisphere on a cylinder half as high as its radius 4.2.
BLUNT = 4.4


def nested_cuts(tree: ArcTree, level: int, area: Floats) -> Bools:
    """Tell which arcs (A,) are cut when all levels up to this one are overlaid.

    Every feature of the level is cut off unless it is blunt, and so is what lies between two of its saddles (the palm
    between fingers and arm), unless it is a thin shell, or no neck shows where it ends.

    Parameters
    ----------
    tree : ArcTree
    level : int
    area : (A,) float64
        Share of each arc in the whole area.
    """
    is_cut = tree.is_cut(level)
    height, longest, inside = tree.height.copy(), tree.longest.copy(), area.copy()
    has_cut_inside = np.zeros(len(area), dtype=bool)
    last: dict[int, int] = {}
    for arc, (part, parent) in enumerate(zip(tree.part.tolist(), tree.parent.tolist(), strict=True)):
        # What has gathered on the way from the last cut.
        previous = last.get(part)
        if previous is not None and not is_cut[previous]:
            height[arc] += height[previous]
            longest[arc] = max(longest[arc], longest[previous])
            inside[arc] += inside[previous]
        last[part] = arc
        if is_cut[arc] and has_cut_inside[arc]:
            is_neck = tree.closing_length[arc] < NECK * longest[arc]
            is_cut[arc] = is_neck and height[arc] > LEAST_HEIGHT and inside[arc] > LEAST_AREA
        elif is_cut[arc]:
            is_cut[arc] = tree.roundness[arc] < BLUNT
        if parent >= 0:
            has_cut_inside[parent] |= has_cut_inside[arc] or is_cut[arc]
    return is_cut
