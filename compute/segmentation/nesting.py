"""Levels overlaid: which cuts between features are worth a part of their own."""

import numpy as np

from ..mesh import Bools, Floats
from .arc_tree import ArcTree
from .necks import LEAST_HEIGHT

# An inner part is worth keeping if its border is a neck: shorter than this fraction of its longest level set.
NECK = 0.7
# And if it has at least this fraction of the area of the whole.
LEAST_AREA = 0.02


def nested_cuts(tree: ArcTree, level: int, area: Floats) -> Bools:
    """Tell which arcs (A,) are cut when all levels up to this one are overlaid.

    Every feature of the level is cut off, and so is what lies between two of its saddles (the palm between fingers and
    arm), unless it is a thin shell, or no neck shows where it ends.

    Parameters
    ----------
    tree : ArcTree
    level : int
    area : (A,) float64
        Share of each arc in the whole area.
    """
    is_cut, is_feature = tree.is_cut(level), tree.is_feature(level)
    height, longest, inside = np.zeros(len(area)), tree.longest.copy(), area.copy()
    last: dict[int, int] = {}
    for arc, part in enumerate(tree.part.tolist()):
        # What has gathered on the way from the last cut.
        previous = last.get(part)
        height[arc] = tree.height[arc]
        if previous is not None and not is_cut[previous]:
            height[arc] += height[previous]
            longest[arc] = max(longest[arc], longest[previous])
            inside[arc] += inside[previous]
        last[part] = arc
        if is_cut[arc] and not is_feature[arc]:
            is_neck = tree.closing_length[arc] < NECK * longest[arc]
            is_cut[arc] = is_neck and height[arc] > LEAST_HEIGHT and inside[arc] > LEAST_AREA
    return is_cut
