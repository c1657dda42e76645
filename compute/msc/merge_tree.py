"""Merge trees: how the components of the sublevel sets are born at minima and merge at saddles.

Everything here sweeps upwards over a rank. The tree of the superlevel sets (maxima) is the same with the rank reversed.
"""

from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Ints
from .critical_points import Sectors, merging_sectors
from .ranked_net import RankedNet


@dataclass(frozen=True, eq=False)
class MergeTree:
    """The merges of a sweep; a component carries the name of its oldest minimum.

    Attributes
    ----------
    rank : (n,) int64
        The order of the sweep.
    descent : (n,) int64
        A lower neighbour of each vertex; itself at minima.
    basin : (n,) int64
        The minimum that the descending path from each vertex ends in.
    extremum, saddle, elder : (p,) int64
        The pairs in the order of the sweep: at ``saddle`` the component of ``extremum`` ends and that of ``elder``
        goes on.
    roots : (r,) int64
        The minima that are in no pair, one for each component of the net.
    sectors : Sectors
        The vertices with several lower components, whether components merge there or a handle closes.
    """

    rank: Ints
    descent: Ints
    basin: Ints
    extremum: Ints
    saddle: Ints
    elder: Ints
    roots: Ints
    sectors: Sectors


def merge_tree(net: RankedNet) -> MergeTree:
    """Sweep a net upwards and pair each minimum with the saddle that ends it (0-dimensional persistence)."""
    descent = _descent(net)
    basin = ends_of_paths(descent)
    sectors = merging_sectors(net)
    extremum, saddle, elder = _elder_rule(net, sectors, basin)
    minima = net.links.vertex[basin[net.links.vertex] == net.links.vertex]
    return MergeTree(
        rank=net.rank,
        descent=descent,
        basin=basin,
        extremum=extremum,
        saddle=saddle,
        elder=elder,
        roots=minima[~np.isin(minima, extremum)],
        sectors=sectors,
    )


def _descent(net: RankedNet) -> Ints:
    """Return a lower neighbour of each vertex that has one.

    Any will do: a path down from a vertex stays in the component of the sublevel set that it starts in.
    """
    low, middle, high = net.corners
    target = np.arange(net.n_vertices)
    target[high] = middle
    target[middle] = low
    return net.vertex_at_rank[target][net.rank]


def ends_of_paths(target: Ints) -> Ints:
    """Follow all paths at once to where they end."""
    while not np.array_equal(target, further := target[target]):
        target = further
    return target


def _elder_rule(net: RankedNet, sectors: Sectors, basin: Ints) -> tuple[Ints, Ints, Ints]:
    """Join the components at each saddle; the younger one (with the higher minimum) is paired and ends."""
    minimum, label = np.unique(net.rank[basin[sectors.lowest]], return_inverse=True)
    minimum = net.vertex_at_rank[minimum]
    # Numbered from the lowest up, so the larger number is the younger one; a component has the number of its oldest.
    older = list(range(len(minimum)))
    ended, going_on, rows = [], [], []
    previous_saddle, first = -1, -1
    for row, (saddle, component) in enumerate(zip(sectors.vertex.tolist(), label.reshape(-1).tolist(), strict=True)):
        if saddle != previous_saddle:
            previous_saddle, first = saddle, component
            continue
        one, other = _oldest(first, older), _oldest(component, older)
        if one != other:
            elder, younger = min(one, other), max(one, other)
            older[younger] = elder
            ended.append(younger)
            going_on.append(elder)
            rows.append(row)
    pairs = np.array([ended, going_on, rows], dtype=np.int64).reshape(3, -1)
    return minimum[pairs[0]], sectors.vertex[pairs[2]], minimum[pairs[1]]


def _oldest(component: int, older: list[int]) -> int:
    """Return the oldest component that one has joined, and shorten the path there by half."""
    while component != older[component]:
        older[component] = component = older[older[component]]
    return component
