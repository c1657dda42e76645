"""From the merge tree of a field to its arc tree: noise is cancelled, and what is left is cut into arcs."""

from dataclasses import dataclass

import numpy as np

from ...msc.merge_tree import MergeTree, ends_of_paths
from ...surface.mesh import Ints
from .arc_tree import NEVER, NO_ARC, NO_SADDLE, ArcTree, without_necks


@dataclass(frozen=True, eq=False)
class ArcPlaces:
    """The places on an arc tree at which the basins of the net begin.

    Attributes
    ----------
    entry : (n,) int64
        For each extremum of the merge tree, the arc its basin starts on: its own leaf or, where it was cancelled as
        noise, the arc that swallowed it.
    cap : (n,) int64
        The rank below which nothing of that basin is left after the noise is cancelled.
    """

    entry: Ints
    cap: Ints


@dataclass(frozen=True, eq=False)
class Features:
    """The extrema and saddles that are not noise, in all trees of a field.

    Attributes
    ----------
    part : (n,) int64
        The number of the part each extremum stands for, 0 for noise and for other net vertices: first those without a
        pair, then by falling persistence.
    closing : (n,) int64
        The place of each saddle's pair by falling persistence, the first of them if it has several; ``ALWAYS`` for
        saddles that survive at every level, and ``NEVER`` for vertices at which no part ends.
    n_roots, n_features : int
        Extrema without a pair, and with one.
    """

    part: Ints
    closing: Ints
    n_roots: int
    n_features: int


def build_arc_tree(tree: MergeTree, is_of_maxima: bool, features: Features) -> tuple[ArcTree, ArcPlaces]:
    """Cancel the noise of a merge tree and cut the rest into arcs, at the saddles of both kinds of extrema.

    A component of the sweep keeps the name of its oldest extremum, so its arcs follow each other: the leaf, then one
    for each merge it outlives and each cut. All are known at once.
    """
    events = _events(tree, features)
    leaf = np.flatnonzero(features.part * (tree.basin == np.arange(len(tree.basin))))
    leaf = leaf[np.argsort(features.part[leaf])]
    extremum = np.concatenate([leaf, events.component])
    chains = _chains(tree, leaf, events)
    parent, saddle = np.full(len(extremum), NO_ARC), np.full(len(extremum), NO_SADDLE)
    parent[chains.arc], saddle[chains.arc] = len(leaf) + chains.event, events.vertex[chains.event]
    part, closing = features.part[extremum], np.where(saddle == NO_SADDLE, NEVER, features.closing[saddle])
    arcs = ArcTree(
        is_of_maxima=is_of_maxima,
        n_roots=features.n_roots,
        n_features=features.n_features,
        parent=parent,
        part=part,
        extremum=extremum,
        saddle=saddle,
        closing=closing,
        joint_part=part,
        joint_closing=closing,
        **without_necks(len(part)),
    )
    return arcs, _places(tree, features, leaf, events, chains)


def arc_of_vertex(tree: MergeTree, arcs: ArcTree, places: ArcPlaces) -> Ints:
    """(n,) the arc each net vertex lies on; a saddle lies on the arc behind it, so parts are open there."""
    arc = places.entry[tree.basin]
    height = np.maximum(tree.rank, places.cap[tree.basin])
    # The root closes at a rank that is never reached.
    closing_rank = np.where(arcs.has_saddle, tree.rank[arcs.saddle], len(tree.rank))
    return _first_open_ancestor(arc, height, arcs.parent, closing_rank)


def _first_open_ancestor(arc: Ints, height: Ints, parent: Ints, closing_rank: Ints) -> Ints:
    """Climb from each arc to the first one that closes above the given height, in jumps of falling powers of two."""
    climbing = np.flatnonzero(height >= closing_rank[arc])
    at, height = arc[climbing], height[climbing]
    jumps = [np.where(parent == NO_ARC, np.arange(len(parent)), parent)]
    while not np.array_equal(jumps[-1], further := jumps[-1][jumps[-1]]):
        jumps.append(further)
    for jump in reversed(jumps):
        target = jump[at]
        at = np.where(height >= closing_rank[target], target, at)
    arc[climbing] = parent[at]
    return arc


# In the place of the component that an event ends.
NO_COMPONENT = -1


@dataclass(frozen=True, eq=False)
class _Events:
    """The events that open arcs, in the order of the sweep: merges of two components that are no noise, and cuts.

    Attributes
    ----------
    vertex, component : (e,) int64
        The net vertex of the event, and the component that goes on.
    ended : (e,) int64
        The component that ends in a merge; ``NO_COMPONENT`` for a cut.
    time : (e,) int64
        The place among all that happens, noise included.
    swallowed, swallowed_at : (w,) int64
        The pairs that are noise, and the same for them.
    """

    vertex: Ints
    component: Ints
    ended: Ints
    time: Ints
    swallowed: Ints
    swallowed_at: Ints


def _events(tree: MergeTree, features: Features) -> _Events:
    cut = np.flatnonzero(features.closing < NEVER)
    cut_component = _component_at(tree, cut)
    # A cut has nothing to do where the component is noise, or where a merge at the same vertex has just opened an arc.
    n, is_kept = len(tree.rank), features.part[tree.extremum] > 0
    is_merged = np.isin(cut * n + cut_component, tree.saddle[is_kept] * n + tree.elder[is_kept])
    is_real = (features.part[cut_component] > 0) & ~is_merged
    cut, cut_component = cut[is_real], cut_component[is_real]
    vertex = np.concatenate([tree.saddle, cut])
    component = np.concatenate([tree.elder, cut_component])
    ended = np.concatenate([tree.extremum, np.full(len(cut), NO_COMPONENT)])
    # The sort is stable: merges come before a cut at one vertex.
    order = np.argsort(tree.rank[vertex], kind="stable")
    time = np.empty(len(order), dtype=np.int64)
    time[order] = np.arange(len(order))
    opens = order[np.concatenate([is_kept, np.ones(len(cut), dtype=bool)])[order]]
    swallowed = np.flatnonzero(~is_kept)
    return _Events(vertex[opens], component[opens], ended[opens], time[opens], swallowed, time[swallowed])


def _component_at(tree: MergeTree, vertex: Ints) -> Ints:
    """Return the component that each vertex is in when the sweep has passed it, by its oldest extremum."""
    elder = np.full(len(tree.rank), NO_ARC)
    elder[tree.extremum] = tree.elder
    end = np.full(len(tree.rank), len(tree.rank))
    end[tree.extremum] = tree.rank[tree.saddle]
    return _first_open_ancestor(tree.basin[vertex], tree.rank[vertex], elder, end)


@dataclass(frozen=True, eq=False)
class _Chains:
    """The arcs of all components one after the other, without the last one of each root.

    Attributes
    ----------
    key : (r,) int64
        Component times the number of events of all kinds plus time, ascending.
    arc, event : (r,) int64
        The arc that is closed, and the event that closes it.
    """

    key: Ints
    arc: Ints
    event: Ints


def _chains(tree: MergeTree, leaf: Ints, events: _Events) -> _Chains:
    n_times = _n_times(events)
    ends = np.flatnonzero(events.ended != NO_COMPONENT)
    component = np.concatenate([events.component, events.ended[ends]])
    event = np.concatenate([np.arange(len(events.vertex)), ends])
    order = np.argsort(component * n_times + events.time[event], kind="stable")
    component, event = component[order], event[order]
    leaf_of = np.zeros(len(tree.rank), dtype=np.int64)
    leaf_of[leaf] = np.arange(len(leaf))
    is_first = np.append(True, component[1:] != component[:-1])
    arc = np.where(is_first, leaf_of[component], len(leaf) + np.roll(event, 1)) if len(event) else event
    return _Chains(component * n_times + events.time[event], arc, event)


def _n_times(events: _Events) -> int:
    return len(events.time) + len(events.swallowed) + 1


def _places(tree: MergeTree, features: Features, leaf: Ints, events: _Events, chains: _Chains) -> ArcPlaces:
    entry, cap = (np.zeros(len(tree.rank), dtype=np.int64) for _ in range(2))
    entry[leaf] = np.arange(len(leaf))
    young, old = tree.extremum[events.swallowed], tree.elder[events.swallowed]
    # The arc that is open in the older component: the leaf, or what the last event before opened.
    key = old * _n_times(events) + events.swallowed_at
    row = chains.key.searchsorted(key) - 1
    is_later = (row >= 0) & (features.part[old] > 0)
    is_later[is_later] = chains.key[row[is_later]] // _n_times(events) == old[is_later]
    entry[young] = entry[old]
    entry[young[is_later]] = len(leaf) + chains.event[row[is_later]]
    cap[young] = tree.rank[tree.saddle[events.swallowed]]
    # What was swallowed by noise went where that noise went, which ended later.
    swallower = np.arange(len(tree.rank))
    by_noise = features.part[old] == 0
    swallower[young[by_noise]] = old[by_noise]
    swallower = ends_of_paths(swallower)
    return ArcPlaces(entry[swallower], cap[swallower])
