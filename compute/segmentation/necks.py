"""Where a shape narrows: the lengths of the level sets along the arcs."""

from dataclasses import replace

import numpy as np

from ..fields import Net, ScalarField
from ..mesh import Bools, Floats, Ints
from .arc_tree import ArcTree

# Level sets that are measured on each arc, evenly spaced over its height.
N_SAMPLES = 8
# An arc lower than this fraction of the field's range is a thin shell; its level sets are not measured.
LEAST_HEIGHT = 0.02


def measured(tree: ArcTree, arc: Ints, field: ScalarField) -> ArcTree:
    """Return the tree with its heights, and the lengths of the level sets on arcs that are no thin shells.

    Parameters
    ----------
    tree : ArcTree
    arc : (n,) int64
        Arc of each vertex of the field's net.
    field : ScalarField
    """
    rising = -field.values if tree.is_of_maxima else field.values
    bottom, top = _heights(rising, tree)
    height = np.where(tree.saddle < 0, 0.0, (top - bottom) / max(field.value_range, float(np.finfo(float).tiny)))
    closing_length, longest = np.zeros(len(height)), np.zeros(len(height))
    tall = np.flatnonzero(height > LEAST_HEIGHT)
    if len(tall):
        closing_length[tall], longest[tall] = _lengths(rising, arc, tree.parent, field.net, tall, bottom, top)
    return replace(tree, height=height, closing_length=closing_length, longest=longest)


def _lengths(
    values: Floats, arc: Ints, parent: Ints, net: Net, chosen: Ints, bottom: Floats, top: Floats
) -> tuple[Floats, Floats]:
    """Return the length of the level sets of the chosen arcs just before they close, and at their longest."""
    order = np.argsort(values[net.triangles], axis=1, kind="stable")
    triangles = np.take_along_axis(net.triangles, order, axis=1)
    low, high = values[triangles[:, 0]], values[triangles[:, 2]]
    innermost = arc[net.triangles].min(axis=1)
    lengths = np.zeros((len(chosen), N_SAMPLES))
    for row, number in enumerate(chosen.tolist()):
        passes = _way_passes(parent, number)[innermost]
        near = triangles[passes & (high > bottom[number]) & (low < top[number])]
        levels = top[number] - (top[number] - bottom[number]) * (np.arange(N_SAMPLES) + 0.05) / N_SAMPLES
        lengths[row] = [_level_set_length(values, near, net.positions, level) for level in levels.tolist()]
    return lengths[:, 0], lengths.max(axis=1)


def _heights(values: Floats, tree: ArcTree) -> tuple[Floats, Floats]:
    """Return the values between which each arc lies: where its leaf is or its children close, and where it closes."""
    top = np.where(tree.saddle < 0, np.inf, values[tree.saddle])
    bottom = values[tree.extremum]
    children = np.flatnonzero(tree.parent >= 0)
    bottom[tree.parent[children]] = top[children]
    return bottom, top


def _way_passes(parent: Ints, number: int) -> Bools:
    """Tell from which arcs (A,) the way to the root passes a given one."""
    passes = np.zeros(len(parent), dtype=bool)
    passes[number] = True
    for arc in range(number - 1, -1, -1):
        passes[arc] = parent[arc] >= 0 and passes[parent[arc]]
    return passes


def _level_set_length(values: Floats, triangles: Ints, positions: Floats, level: float) -> float:
    """Return the length of a level set in triangles whose corners are sorted by value."""
    a, b, c = values[triangles].T
    crossed = (a < level) & (level < c)
    a, b, c = a[crossed], b[crossed], c[crossed]
    low, middle, high = positions[triangles[crossed]].swapaxes(0, 1)
    below = level <= b
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(below, (level - a) / (b - a), (level - b) / (c - b))[:, None]
    short_side = np.where(below[:, None], low + share * (middle - low), middle + share * (high - middle))
    long_side = low + ((level - a) / (c - a))[:, None] * (high - low)
    return float(np.linalg.norm(long_side - short_side, axis=1).sum())
