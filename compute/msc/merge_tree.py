"""Merge trees: how the components of the sublevel sets are born at minima and merge at saddles.

Everything here sweeps upwards over a rank. The tree of the superlevel sets (maxima) is the same with the rank reversed.
"""

from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Ints
from .critical_points import Sectors, merging_sectors, perhaps_critical, ranked_corners, vertices_by_rank
from .links import Links


@dataclass(frozen=True, eq=False)
class MergeTree:
    """All merges of a sweep; a component carries the name of its oldest minimum.

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


def merge_tree(rank: Ints, links: Links, candidates: Ints | None = None) -> MergeTree:
    """Sweep the net upwards and pair each minimum with the saddle that ends it (0-dimensional persistence).

    Parameters
    ----------
    rank : (n,) int64
    links : Links
    candidates : (c,) int64, optional
        The vertices that are perhaps critical, if they are known.
    """
    descent = _descent(rank, links)
    basin = ends_of_paths(descent)
    sectors = merging_sectors(rank, links, perhaps_critical(rank, links) if candidates is None else candidates)
    extremum, saddle, elder = _elder_rule(rank, sectors, basin)
    minima = links.vertex[basin[links.vertex] == links.vertex]
    roots = minima[~np.isin(minima, extremum)]
    return MergeTree(rank, descent, basin, extremum, saddle, elder, roots, sectors)


def _descent(rank: Ints, links: Links) -> Ints:
    """Return a lower neighbour of each vertex that has one.

    Any will do: a path down from a vertex stays in the component of the sublevel set that it starts in.
    """
    low, middle, high = ranked_corners(rank, links)
    target = np.arange(links.n_vertices)
    target[high] = middle
    target[middle] = low
    return vertices_by_rank(rank)[target][rank]


def ends_of_paths(target: Ints) -> Ints:
    """Follow all paths at once to where they end."""
    while not np.array_equal(target, further := target[target]):
        target = further
    return target


def _elder_rule(rank: Ints, sectors: Sectors, basin: Ints) -> tuple[Ints, Ints, Ints]:
    """Join the components at each saddle; the younger one (with the higher minimum) is paired and ends."""
    minimum, label = np.unique(rank[basin[sectors.lowest]], return_inverse=True)
    minimum = vertices_by_rank(rank)[minimum]
    # Numbered from the lowest up, so the larger number is the younger one; a component has the number of its oldest.
    older = list(range(len(minimum)))
    young, old, at = [], [], []
    previous_saddle, first = -1, -1
    for row, (saddle, there) in enumerate(zip(sectors.vertex.tolist(), label.reshape(-1).tolist(), strict=True)):
        if saddle != previous_saddle:
            previous_saddle, first = saddle, there
            continue
        here = first
        while here != older[here]:
            older[here] = here = older[older[here]]
        while there != older[there]:
            older[there] = there = older[older[there]]
        if here != there:
            here, there = min(here, there), max(here, there)
            older[there] = here
            young.append(there)
            old.append(here)
            at.append(row)
    rows = np.array(at, dtype=np.int64)
    return minimum[np.array(young, dtype=np.int64)], sectors.vertex[rows], minimum[np.array(old, dtype=np.int64)]
