"""Heights, necks and roundness of arcs, from the lengths of the level sets along them."""

from dataclasses import dataclass

import numpy as np

from ...fields.scalar_field import Net, ScalarField, share_below
from ...surface.mesh import Floats, Ints
from .arc_tree import ArcTree

# Level sets that are measured on each arc, evenly spaced over its height.
N_SAMPLES = 8
# Places in the area inside an arc that closes last at which its level sets are measured, too: the ball of a barbell
# takes next to nothing of the height.
PLACES = np.linspace(0.0, 1.0, 13)
# An arc lower than this fraction of the field's range is a thin shell; its level sets are not measured.
LEAST_HEIGHT = 0.02
# The tip of a part, this fraction of its area, is left out of its roundness: every tip is round.
TIP = 0.3


@dataclass(frozen=True, eq=False)
class ArcMeasures:
    """The sizes of the arcs of a tree, by the level sets along them.

    Attributes
    ----------
    height : (A,) float64
        Difference of the field between the two ends of the arc, as a fraction of its range; 0 where it closes at no
        saddle.
    closing_length, longest : (A,) float64
        Length of the level set where the arc closes and at its longest inside; 0 where it was not worth measuring.
    widest : (A,) float64
        As ``longest``; of two arcs that close last, the longest by their area, too.
    roundness : (A,) float64
        The least length²/area of all level sets from the leaf to where the arc closes, area being what they cut off:
        4 pi for a flat disk, 2 pi for a hemisphere, less for a longer protrusion; where an arc was not worth measuring,
        that of the last one before it, 0 if none was.
    """

    height: Floats
    closing_length: Floats
    longest: Floats
    widest: Floats
    roundness: Floats


def measure_arcs(tree: ArcTree, arc: Ints, field: ScalarField) -> ArcMeasures:
    """Measure the heights of all arcs, and the level sets of those that are no thin shells.

    Parameters
    ----------
    tree : ArcTree
    arc : (n,) int64
        Arc of each vertex of the field's net.
    field : ScalarField
    """
    rising = -field.values if tree.is_of_maxima else field.values
    bottom, top = ends_of_arcs(rising, tree)
    height = np.where(tree.has_saddle, top - bottom, 0.0) / max(field.value_range, float(np.finfo(float).tiny))
    tall = np.flatnonzero(height > LEAST_HEIGHT)
    levels = top[tall, None] - (top - bottom)[tall, None] * (np.arange(N_SAMPLES) + 0.05) / N_SAMPLES
    length, area = np.zeros((2, len(height), N_SAMPLES))
    length[tall], area[tall] = _level_sets(rising, arc, tree, field.net, tall, levels)
    longest = length.max(axis=1)
    widest = longest.copy()
    for root in np.flatnonzero(tree.is_root).tolist():
        ends = tall[tree.parent[tall] == root]
        if len(ends) == 2:
            inside = [rising[tree.subtree(end)[arc]] for end in ends.tolist()]
            by_area = np.stack([np.quantile(heights, PLACES) for heights in inside])
            # Between two of them, as a level set through a whole ring of vertices crosses no triangle.
            by_area = (by_area[:, 1:] + by_area[:, :-1]) / 2
            lengths, _ = _level_sets(rising, arc, tree, field.net, ends, by_area)
            widest[ends] = np.maximum(longest[ends], lengths.max(axis=1))
    return ArcMeasures(height, length[:, 0], longest, widest, roundness=_roundness(tree.part, length, area))


def _level_sets(
    values: Floats, arc: Ints, tree: ArcTree, net: Net, chosen: Ints, levels: Floats
) -> tuple[Floats, Floats]:
    """Return the lengths of level sets of the chosen arcs, and the areas they cut off."""
    order = np.argsort(values[net.triangles], axis=1, kind="stable")
    triangles = np.take_along_axis(net.triangles, order, axis=1)
    heights = values[triangles]
    lowest, highest = heights[:, 0].copy(), heights[:, 2].copy()
    innermost = np.minimum.reduce([arc[corner] for corner in net.triangles.T])
    length, area = np.zeros((2, *levels.shape))
    for row, number in enumerate(chosen.tolist()):
        above = tree.subtree(number)[innermost]
        whole = above & (highest <= levels[row].min())
        near = np.flatnonzero(above & ~whole & (lowest < levels[row].max()))
        for column, level in enumerate(levels[row].tolist()):
            length[row, column] = _level_set_length(heights[near], net.positions[triangles[near]], level)
            area[row, column] = net.areas[near] @ share_below(heights[near], np.array(level))
        area[row] += net.areas[whole].sum()
    return length, area


def _roundness(part: Ints, length: Floats, area: Floats) -> Floats:
    """Return the least length²/area of the level sets between each arc's leaf and its end, tips left out."""
    roundness = np.zeros(len(part))
    last: dict[int, int] = {}
    for arc, leaf in enumerate(part.tolist()):
        if not area[arc, 0]:
            roundness[arc] = roundness[last[leaf]] if leaf in last else 0.0
            continue
        last[leaf] = arc
        on_path = part[: arc + 1] == leaf
        lengths, areas = length[: arc + 1][on_path], area[: arc + 1][on_path]
        counted = areas > TIP * area[arc, 0]
        roundness[arc] = (lengths[counted] ** 2 / areas[counted]).min()
    return roundness


def ends_of_arcs(values: Floats, tree: ArcTree) -> tuple[Floats, Floats]:
    """Return the values between which each arc lies: where its leaf is or its children close, and where it closes."""
    # What closes at no saddle has no upper end; any number will do there.
    top = np.where(tree.has_saddle, values[tree.saddle], 0.0)
    bottom = values[tree.extremum]
    children = np.flatnonzero(tree.has_saddle)
    bottom[tree.parent[children]] = top[children]
    return bottom, top


def _level_set_length(heights: Floats, corners: Floats, level: float) -> float:
    """Return the length of a level set in triangles (m, 3) whose corners (m, 3, 3) are sorted by height."""
    crossed = (heights[:, 0] < level) & (level < heights[:, 2])
    return float(lengths_across(heights[crossed], corners[crossed], np.array(level)).sum())


def lengths_across(heights: Floats, corners: Floats, level: Floats) -> Floats:
    """Return the length of a level set in each triangle that it crosses, with corners (m, 3, 3) sorted by height."""
    a, b, c = heights.T
    low, middle, high = corners.swapaxes(0, 1)
    below = level <= b
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(below, (level - a) / (b - a), (level - b) / (c - b))[:, None]
    short_side = np.where(below[:, None], low + share * (middle - low), middle + share * (high - middle))
    long_side = low + ((level - a) / (c - a))[:, None] * (high - low)
    return np.linalg.norm(long_side - short_side, axis=1)
