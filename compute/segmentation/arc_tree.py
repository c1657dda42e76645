"""The noise-free merge tree, cut into arcs at every saddle where a part may end.

A part is always a subtree, so a segmentation at any level is one label for each arc.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..mesh import Bools, Floats, Ints
from ..msc.merge_tree import MergeTree


@dataclass(frozen=True, eq=False)
class ArcTree:
    """Arcs of a merge tree whose noise is cancelled.

    Attributes
    ----------
    is_of_maxima : bool
        Whether the leaves are maxima (superlevel sets) or minima (sublevel sets).
    parent : (A,) int64
        The arc that goes on behind the saddle at which this one closes, always of larger index; -1 for the root.
    part : (A,) int64
        The part named after the most extreme leaf above the arc.
    extremum : (A,) int64
        That leaf, a net vertex.
    saddle : (A,) int64
        Net vertex at which the arc closes; -1 for the root.
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
        before = np.full(len(self.part), _NEVER)
        smallest: dict[int, int] = {}
        # A parent has a larger index than its children, so the way from a leaf is met in its order.
        for arc, (part, closing) in enumerate(zip(self.part.tolist(), self.closing.tolist(), strict=True)):
            before[arc] = smallest.get(part, _NEVER)
            smallest[part] = min(closing, smallest.get(part, _NEVER))
        return before

    @cached_property
    def least_closing_inside(self) -> Ints:
        """(A,) the smallest ``closing`` of all arcs strictly inside the subtree of each arc."""
        least = np.full(len(self.part), _NEVER)
        for arc, parent in enumerate(self.parent.tolist()):
            if parent >= 0:
                least[parent] = min(least[parent], least[arc], self.closing[arc])
        return least

    def is_cut(self, level: int) -> Bools:
        """Tell which arcs (A,) of surviving leaves a surviving saddle closes."""
        return (self.closing < level) & (self.part <= self.n_roots + level)

    def is_feature(self, level: int) -> Bools:
        """Tell which arcs (A,) are whole parts of a level: the first cut on the way from each surviving leaf."""
        return self.is_cut(level) & (self.closing_before >= level)

    def spread(self, part: Ints) -> Ints:
        """Return the parts (A,) of all arcs, given those of the cut ones and 0 elsewhere."""
        part = part.copy()
        for arc in range(len(part) - 1, -1, -1):
            if part[arc] == 0 and self.parent[arc] >= 0:
                part[arc] = part[self.parent[arc]]
        return part


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
_NEVER = np.iinfo(np.int64).max


@dataclass(frozen=True, eq=False)
class Features:
    """What is not noise, in all trees of a field.

    Attributes
    ----------
    part_of_extremum : dict
        The number of the part each extremum stands for: first those without a pair, then by falling persistence.
    closing_of_saddle : dict
        The place of each saddle's pair by falling persistence, the first of them if it has several.
    n_roots : int
        Extrema without a pair.
    """

    part_of_extremum: dict[int, int]
    closing_of_saddle: dict[int, int]
    n_roots: int


def build_arc_tree(tree: MergeTree, is_of_maxima: bool, features: Features) -> tuple[ArcTree, ArcPlaces]:
    """Cancel the noise of a merge tree and cut the rest into arcs, at the saddles of both kinds of extrema."""
    growth = _Growth(tree, features)
    for vertex, pair in _events(tree, np.array(list(features.closing_of_saddle), dtype=np.int64)):
        if pair < 0:
            growth.cut(vertex)
        elif int(tree.extremum[pair]) in features.part_of_extremum:
            growth.merge(pair)
        else:
            growth.swallow(pair)
    return growth.arc_tree(is_of_maxima), growth.places()


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


def _events(tree: MergeTree, cuts: Ints) -> Iterator[tuple[int, int]]:
    """Yield (vertex, pair) in the order of the sweep, pair -1 for a cut; merges come before a cut at one vertex."""
    vertex = np.concatenate([tree.saddle, cuts])
    pair = np.concatenate([np.arange(len(tree.saddle)), np.full(len(cuts), -1)])
    order = np.argsort(tree.rank[vertex], kind="stable")
    yield from zip(vertex[order].tolist(), pair[order].tolist(), strict=True)


class _Growth:
    """An arc tree while its sweep goes on."""

    def __init__(self, tree: MergeTree, features: Features) -> None:
        self._tree = tree
        self._features = features
        self._opened_at: list[int] = []
        self._parent: list[int] = []
        self._extremum: list[int] = []
        self._saddle: list[int] = []
        self._closing: list[int] = []
        # The youngest arc of each component that goes on, under the name of its oldest extremum.
        own = [extremum for extremum in features.part_of_extremum if tree.basin[extremum] == extremum]
        self._open = {extremum: self._new_arc(extremum) for extremum in own}
        self._survivor: dict[int, int] = {}
        self._swallowed: list[tuple[int, int, int]] = []
        self._entry = dict(self._open)

    def merge(self, pair: int) -> None:
        """Close the arcs of both components of a pair and open the one behind the saddle."""
        young, saddle, old = self._row(pair)
        arc = self._new_arc(old, saddle)
        for component in (young, old):
            self._close(self._open.pop(component), arc, saddle)
        self._open[old] = arc
        self._survivor[young] = old

    def swallow(self, pair: int) -> None:
        """Let a component that is noise vanish in the older one."""
        young, saddle, old = self._row(pair)
        self._survivor[young] = old
        self._swallowed.append((young, saddle, old))
        if old in self._open:
            self._entry[young] = self._open[old]

    def cut(self, vertex: int) -> None:
        """Close the arc just below a vertex, and go on with a new one."""
        component = self._component(int(self._tree.basin[vertex]))
        arc = self._open.get(component)
        if arc is None or self._opened_at[arc] == vertex:
            return
        self._open[component] = self._new_arc(self._extremum[arc], vertex)
        self._close(arc, self._open[component], vertex)

    def arc_tree(self, is_of_maxima: bool) -> ArcTree:
        """Return what has grown."""
        part = [self._features.part_of_extremum[extremum] for extremum in self._extremum]
        columns = (np.array(column) for column in (self._parent, part, self._extremum, self._saddle, self._closing))
        n_features = len(self._features.part_of_extremum) - self._features.n_roots
        return ArcTree(is_of_maxima, self._features.n_roots, n_features, *columns, *np.zeros((4, len(part))))

    def places(self) -> ArcPlaces:
        """Return where the basins of all extrema start."""
        entry = np.zeros(len(self._tree.rank), dtype=np.int64)
        cap = np.zeros(len(self._tree.rank), dtype=np.int64)
        entry[list(self._entry)] = list(self._entry.values())
        # What was swallowed by noise shares the fate of that noise, which ended later.
        for young, saddle, old in reversed(self._swallowed):
            is_noise = young not in self._entry
            entry[young] = entry[old] if is_noise else self._entry[young]
            cap[young] = cap[old] if is_noise else self._tree.rank[saddle]
        return ArcPlaces(entry, cap)

    def _row(self, pair: int) -> tuple[int, int, int]:
        tree = self._tree
        return int(tree.extremum[pair]), int(tree.saddle[pair]), int(tree.elder[pair])

    def _component(self, extremum: int) -> int:
        survivor = self._survivor
        while (heir := survivor.get(extremum, extremum)) != extremum:
            survivor[extremum] = extremum = survivor.get(heir, heir)
        return extremum

    def _new_arc(self, extremum: int, opened_at: int = -1) -> int:
        self._opened_at.append(opened_at)
        self._parent.append(-1)
        self._extremum.append(extremum)
        self._saddle.append(-1)
        self._closing.append(_NEVER)
        return len(self._parent) - 1

    def _close(self, arc: int, parent: int, saddle: int) -> None:
        self._parent[arc], self._saddle[arc] = parent, saddle
        self._closing[arc] = self._features.closing_of_saddle[saddle]
