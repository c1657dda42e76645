"""Limbs: the features of the default level, as tubes of level sets from the tip to where they end."""

from dataclasses import dataclass

import numpy as np

from ...fields.scalar_field import Net, ScalarField, steepness
from ...surface.mesh import Floats, Ints, sum_by
from .arc_measures import ends_of_arcs, lengths_across
from .arc_tree import NO_ARC, ArcTree

# Level sets that are measured on each arc, evenly spaced over its height.
N_LEVEL_SETS = 96
# An arc lower than this fraction of the field's range is left out.
LEAST_HEIGHT = 0.005


@dataclass(frozen=True, eq=False)
class Limb:
    """A feature from its tip to the saddle where it ends, by n level sets across it.

    Attributes
    ----------
    end : int
        The arc at which it is cut off.
    arc : (n,) int64
        The arc that each level set lies on.
    height : (n,) float64
        The value of the field, or its negative for maxima, so that it rises from the tip.
    along : (n,) float64
        Where each level set lies, from 0 at the tip to 1 at the end: the mean distance along the limb.
    length : (n,) float64
        Of each level set.
    inside : (n,) float64
        Area that each cuts off, as a fraction of the limb's.
    area : float
    share : float
        Of the limb in the area of its shell.
    """

    end: int
    arc: Ints
    height: Floats
    along: Floats
    length: Floats
    inside: Floats
    area: float
    share: float


def find_limbs(tree: ArcTree, arc: Ints, field: ScalarField, default_level: int) -> list[Limb]:
    """Return the features of a level with the level sets across them, by the arcs at which they end.

    Parameters
    ----------
    tree : ArcTree
    arc : (n,) int64
        Arc of each vertex of the field's net.
    field : ScalarField
    default_level : int
    """
    rising = -field.values if tree.is_of_maxima else field.values
    bottom, top = ends_of_arcs(rising, tree)
    ends = np.flatnonzero(tree.is_feature(default_level) & tree.has_saddle)
    is_tall = top - bottom > LEAST_HEIGHT * field.value_range
    chains = [chain[is_tall[chain]] for chain in (_chain(tree, end) for end in ends.tolist())]
    measured = np.concatenate([*chains, np.zeros(0, dtype=np.int64)])
    heights = bottom[measured, None] + ((top - bottom)[measured, None] * (np.arange(N_LEVEL_SETS) + 0.5)) / N_LEVEL_SETS
    length, width = _level_sets(rising, arc, tree, field.net, measured, heights)
    limb, joins = _places_on_limbs(tree, ends, top)
    mass = sum_by(field.net.triangles.ravel(), np.repeat(field.net.areas / 3, 3), len(rising))
    shell = sum_by(tree.shell[arc], mass, len(tree.parent))
    at = np.maximum(rising, joins[arc])
    limbs = []
    for end, chain in zip(ends.tolist(), chains, strict=True):
        rows = np.isin(measured, chain)
        if rows.any():
            own = np.flatnonzero(limb[arc] == end)
            columns = heights[rows].ravel(), length[rows].ravel(), width[rows].ravel()
            limbs.append(
                _limb(end, np.repeat(chain, N_LEVEL_SETS), *columns, at[own], mass[own], shell[tree.shell[end]])
            )
    return limbs


def _chain(tree: ArcTree, end: int) -> Ints:
    """Return the arcs from the leaf that names an arc to the arc: a part's arcs follow each other."""
    return np.flatnonzero(tree.part[: end + 1] == tree.part[end])


def _places_on_limbs(tree: ArcTree, ends: Ints, top: Floats) -> tuple[Ints, Floats]:
    """Return (A,) the end of the limb that each arc is in, and the height at which it joins the chain of that limb."""
    limb, joins = np.full(len(tree.parent), NO_ARC), np.full(len(tree.parent), -np.inf)
    limb[ends] = ends
    for arc in range(len(limb) - 1, -1, -1):
        parent = tree.parent[arc]
        if limb[arc] == NO_ARC and parent != NO_ARC and limb[parent] != NO_ARC:
            limb[arc] = limb[parent]
            if tree.part[arc] != tree.part[limb[arc]]:
                joins[arc] = max(joins[parent], top[arc])
    return limb, joins


def _limb(
    end: int, arc: Ints, height: Floats, length: Floats, width: Floats, at: Floats, mass: Floats, shell: float
) -> Limb:
    """Make a limb, given where its vertices count and what area they stand for."""
    step = np.divide(width, length, out=np.zeros_like(width), where=length > 0) * np.gradient(height)
    order = np.argsort(at, kind="stable")
    total = float(mass.sum())
    inside = np.append(0.0, np.cumsum(mass[order]))[np.searchsorted(at[order], height)]
    along = (np.cumsum(step) - step / 2) / max(float(step.sum()), float(np.finfo(float).tiny))
    return Limb(end, arc, height, along, length, inside / total, total, total / shell)


def _level_sets(
    rising: Floats, arc: Ints, tree: ArcTree, net: Net, chosen: Ints, levels: Floats
) -> tuple[Floats, Floats]:
    """Return the lengths (c, n) of level sets on the chosen arcs, and their areas for each unit of height."""
    row_of_arc = np.full(len(tree.parent), -1)
    row_of_arc[chosen] = np.arange(len(chosen))
    triangle, row = _rows_of_triangles(arc[net.triangles], tree.parent, row_of_arc)
    order = np.argsort(rising[net.triangles[triangle]], axis=1, kind="stable")
    corners = np.take_along_axis(net.triangles[triangle], order, axis=1)
    heights = rising[corners]
    first, spacing = levels[row, 0], (levels[row, 1] - levels[row, 0])
    start = np.clip(np.ceil((heights[:, 0] - first) / spacing), 0, N_LEVEL_SETS).astype(np.int64)
    stop = np.clip(np.ceil((heights[:, 2] - first) / spacing), 0, N_LEVEL_SETS).astype(np.int64)
    count = np.maximum(stop - start, 0)
    crossed = np.repeat(np.arange(len(row)), count)
    column = np.repeat(start, count) + np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    positions, heights = net.positions[corners], heights[crossed]
    lengths = np.nan_to_num(lengths_across(heights, positions[crossed], levels[row[crossed], column]))
    slope = steepness(net.positions[corners], rising[corners])[crossed]
    widths = np.divide(lengths, slope, out=np.zeros_like(lengths), where=slope > 0)
    cell = row[crossed] * N_LEVEL_SETS + column
    length, width = (sum_by(cell, each, levels.size).reshape(levels.shape) for each in (lengths, widths))
    return length, width


def _rows_of_triangles(arcs: Ints, parent: Ints, row_of_arc: Ints) -> tuple[Ints, Ints]:
    """Return each triangle with the row of each arc that it reaches over, as far as it has one."""
    triangle, current, last = np.arange(len(arcs)), arcs.min(axis=1), arcs.max(axis=1)
    rows = []
    while len(triangle):
        is_chosen = row_of_arc[current] >= 0
        rows.append((triangle[is_chosen], row_of_arc[current[is_chosen]]))
        goes_on = current != last[triangle]
        triangle, current = triangle[goes_on], parent[current[goes_on]]
    return np.concatenate([row[0] for row in rows]), np.concatenate([row[1] for row in rows])
