"""The noise-free merge tree, cut into arcs at every saddle where a part may end.

A part is always a subtree, so a segmentation at any level is one label for each arc.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...msc.merge_tree import MergeTree, ends_of_paths
from ...surface.mesh import Bools, Floats, Ints


@dataclass(frozen=True, eq=False)
class ArcTree:
    """Arcs of a merge tree whose noise is cancelled.

    Attributes
    ----------
    is_of_maxima : bool
        Whether the leaves are maxima (superlevel sets) or minima (sublevel sets).
    parent : (A,) int64
        The arc that goes on behind the saddle at which this one closes, always of larger index; -1 for the root.
        Around each further shell that was analyzed by itself there is an arc that closes at no saddle.
    part : (A,) int64
        The part named after the most extreme leaf above the arc.
    extremum : (A,) int64
        That leaf, a net vertex.
    saddle : (A,) int64
        Net vertex at which the arc closes; -1 for the root, and where it is a whole shell.
    closing : (A,) int64
        The level from which on that saddle survives, less one: the place of its pair by falling persistence, the
        first of them if it has several, -1 where it survives always. The root has a number that no level reaches.
    n_roots : int
        Parts with the numbers 1 to this have no pair and survive always; the next numbers follow the pairs.
    n_features : int
        Pairs that are not noise, in all trees.
    height : (A,) float64
        Difference of the field between the two ends of the arc, as a fraction of its range; 0 for the root.
    closing_length, longest : (A,) float64
        Length of the level set where the arc closes and at its longest inside; 0 where it was not worth measuring.
    roundness : (A,) float64
        The least length²/area of all level sets from the leaf to where the arc closes, area being what they cut off:
        4 pi for a flat disk, 2 pi for a hemisphere, less the more it stands out; 0 where it was not worth measuring.
    """

    is_of_maxima: bool
    n_roots: int
    n_features: int
    parent: Ints
    part: Ints
    extremum: Ints
    saddle: Ints
    closing: Ints
    height: Floats
    closing_length: Floats
    longest: Floats
    roundness: Floats

    @cached_property
    def closing_before(self) -> Ints:
        """(A,) the smallest ``closing`` on the way from the leaf that names the arc to the arc, itself left out."""
        before = np.full(len(self.part), NEVER)
        smallest: dict[int, int] = {}
        # A parent has a larger index than its children, so the way from a leaf is met in its order.
        for arc, (part, closing) in enumerate(zip(self.part.tolist(), self.closing.tolist(), strict=True)):
            before[arc] = smallest.get(part, NEVER)
            smallest[part] = min(closing, smallest.get(part, NEVER))
        return before

    @cached_property
    def least_closing_inside(self) -> Ints:
        """(A,) the smallest ``closing`` of all arcs strictly inside the subtree of each arc."""
        least = np.full(len(self.part), NEVER)
        for arc, parent in enumerate(self.parent.tolist()):
            if parent >= 0:
                least[parent] = min(least[parent], least[arc], self.closing[arc])
        return least

    @cached_property
    def is_shell(self) -> Bools:
        """(A,) which arcs are whole shells beside the first; they are parts at every level."""
        return (self.saddle < 0) & (self.closing < 0)

    @cached_property
    def ground(self) -> Ints:
        """(A,) the arc of the whole shell that each arc lies on; the root for the first shell."""
        number = np.arange(len(self.parent))
        return self.spread(np.where(self.is_shell | (self.parent < 0), number + 1, 0)) - 1

    @property
    def body(self) -> Ints:
        """(A,) the part that is left of each arc's shell when all others are cut off: 0 on the first shell."""
        return np.where(self.is_shell, self.part, 0)[self.ground]

    def is_cut(self, level: int) -> Bools:
        """Tell which arcs (A,) of surviving leaves a surviving saddle closes."""
        return (self.closing < level) & (self.part <= self.n_roots + level)

    def is_feature(self, level: int) -> Bools:
        """Tell which arcs (A,) are whole parts of a level: the first cut on the way from each surviving leaf."""
        return self.is_cut(level) & (self.closing_before >= level)

    def subtree(self, arc: int) -> Bools:
        """Tell which arcs (A,) lie in the part that is cut off at one, itself included."""
        inside = np.zeros(len(self.parent), dtype=bool)
        inside[arc] = True
        for inner in range(arc - 1, -1, -1):
            inside[inner] = self.parent[inner] >= 0 and inside[self.parent[inner]]
        return inside

    def spread(self, part: Ints) -> Ints:
        """Return the parts (A,) of all arcs, given those of the cut ones and 0 elsewhere."""
        part = part.copy()
        for arc in range(len(part) - 1, -1, -1):
            if part[arc] == 0 and self.parent[arc] >= 0:
                part[arc] = part[self.parent[arc]]
        return part


def flat_tree(n_parts: int, is_of_maxima: bool) -> ArcTree:
    """Return a tree of parts that all end at its root: what single borders cut off, and the rest."""
    n, part = n_parts + 1, np.arange(1, n_parts + 2)
    ends = np.append(np.zeros(n_parts, dtype=np.int64), -1)
    parent = np.where(ends < 0, -1, n_parts)
    closing = np.where(ends < 0, NEVER, -1)
    return ArcTree(is_of_maxima, n, 0, parent, part, np.zeros(n, dtype=np.int64), ends, closing, *np.zeros((4, n)))


@dataclass(frozen=True, eq=False)
class ArcPlaces:
    """Where the vertices of the net lie on an arc tree.

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


# More than any number of pairs.
NEVER = np.iinfo(np.int64).max


@dataclass(frozen=True, eq=False)
class Features:
    """What is not noise, in all trees of a field.

    Attributes
    ----------
    part : (n,) int64
        The number of the part each extremum stands for, 0 for noise and for other net vertices: first those without a
        pair, then by falling persistence.
    closing : (n,) int64
        The place of each saddle's pair by falling persistence, the first of them if it has several, -1 for saddles
        that survive always; where parts never end, a number that no level reaches.
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
    parent, saddle = np.full(len(extremum), -1), np.full(len(extremum), -1)
    parent[chains.arc], saddle[chains.arc] = len(leaf) + chains.event, events.vertex[chains.event]
    closing = np.where(saddle < 0, NEVER, features.closing[saddle])
    arcs = ArcTree(
        is_of_maxima,
        features.n_roots,
        features.n_features,
        parent,
        features.part[extremum],
        extremum,
        saddle,
        closing,
        *np.zeros((4, len(extremum))),
    )
    return arcs, _places(tree, features, leaf, events, chains)


def arc_of_vertex(tree: MergeTree, arcs: ArcTree, places: ArcPlaces) -> Ints:
    """(n,) the arc each net vertex lies on; a saddle lies on the arc behind it, so parts are open there."""
    arc = places.entry[tree.basin]
    height = np.maximum(tree.rank, places.cap[tree.basin])
    # The root closes at a rank that is never reached.
    closing_rank = np.where(arcs.saddle < 0, len(tree.rank), tree.rank[arcs.saddle])
    return _first_open_ancestor(arc, height, arcs.parent, closing_rank)


def _first_open_ancestor(arc: Ints, height: Ints, parent: Ints, closing_rank: Ints) -> Ints:
    """Climb from each arc to the first one that closes above the given height, in jumps of falling powers of two."""
    climbing = np.flatnonzero(height >= closing_rank[arc])
    at, height = arc[climbing], height[climbing]
    jumps = [np.where(parent < 0, np.arange(len(parent)), parent)]
    while not np.array_equal(jumps[-1], further := jumps[-1][jumps[-1]]):
        jumps.append(further)
    for jump in reversed(jumps):
        target = jump[at]
        at = np.where(height >= closing_rank[target], target, at)
    arc[climbing] = parent[at]
    return arc


@dataclass(frozen=True, eq=False)
class _Events:
    """What opens arcs, in the order of the sweep: merges of two components that are no noise, and cuts.

    Attributes
    ----------
    vertex, component : (e,) int64
        Where, and the component that goes on.
    ended : (e,) int64
        The component that ends in a merge; -1 for a cut.
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
    merged_here = np.isin(cut * n + cut_component, tree.saddle[is_kept] * n + tree.elder[is_kept])
    is_real = (features.part[cut_component] > 0) & ~merged_here
    cut, cut_component = cut[is_real], cut_component[is_real]
    vertex = np.concatenate([tree.saddle, cut])
    component = np.concatenate([tree.elder, cut_component])
    ended = np.concatenate([tree.extremum, np.full(len(cut), -1)])
    # The sort is stable: merges come before a cut at one vertex.
    order = np.argsort(tree.rank[vertex], kind="stable")
    time = np.empty(len(order), dtype=np.int64)
    time[order] = np.arange(len(order))
    opens = order[np.concatenate([is_kept, np.ones(len(cut), dtype=bool)])[order]]
    swallowed = np.flatnonzero(~is_kept)
    return _Events(vertex[opens], component[opens], ended[opens], time[opens], swallowed, time[swallowed])


def _component_at(tree: MergeTree, vertex: Ints) -> Ints:
    """Return the component that each vertex is in when the sweep has passed it, by its oldest extremum."""
    elder = np.full(len(tree.rank), -1)
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
    ends = np.flatnonzero(events.ended >= 0)
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
    # What was swallowed by noise shares the fate of that noise, which ended later.
    fate = np.arange(len(tree.rank))
    by_noise = features.part[old] == 0
    fate[young[by_noise]] = old[by_noise]
    fate = ends_of_paths(fate)
    return ArcPlaces(entry[fate], cap[fate])
