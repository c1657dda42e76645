"""The noise-free merge tree, cut into arcs at every saddle where a part may end.

A part is always a subtree, so a segmentation at any level is one label for each arc.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..mesh import Bools, Ints
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
        first of them if it has several. The root has a number that no level reaches.
    n_roots : int
        Parts with the numbers 1 to this have no pair and survive always; the next numbers follow the pairs.
    """

    is_of_maxima: bool
    n_roots: int
    parent: Ints
    part: Ints
    extremum: Ints
    saddle: Ints
    closing: Ints

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

    def is_part_root(self, level: int) -> Bools:
        """Tell which arcs (A,) are whole parts of a level.

        These are the arcs of surviving leaves that a surviving saddle closes, the first on the way from the leaf.
        """
        is_first = (self.closing < level) & (self.closing_before >= level)
        return is_first & (self.part <= self.n_roots + level)

    def part_of_arc(self, level: int) -> Ints:
        """Return the part (A,) each arc belongs to at a level, 0 for the body."""
        part = np.where(self.is_part_root(level), self.part, 0)
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


def build_arc_tree(
    tree: MergeTree,
    is_of_maxima: bool,
    part_of_extremum: dict[int, int],
    closing_of_saddle: dict[int, int],
    n_roots: int,
) -> tuple[ArcTree, ArcPlaces]:
    """Cancel the noise of a merge tree and cut the rest into arcs.

    Parameters
    ----------
    tree : MergeTree
        With p pairs.
    is_of_maxima : bool
        Which sweep the tree comes from.
    part_of_extremum : dict
        Part of each extremum of this tree that is not noise.
    closing_of_saddle : dict
        The ``closing`` of all saddles that are not noise; those of the other kind of extremum cut the arc below them.
    n_roots : int
        Parts that have no pair, in all trees.
    """
    growth = _Growth(tree, part_of_extremum)
    for vertex, pair in _events(tree, np.array(list(closing_of_saddle), dtype=np.int64)):
        if pair < 0:
            growth.cut(vertex, closing_of_saddle[vertex])
        elif int(tree.extremum[pair]) in part_of_extremum:
            growth.merge(pair, closing_of_saddle[vertex])
        else:
            growth.swallow(pair)
    return growth.arc_tree(is_of_maxima, n_roots), growth.places()


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

    def __init__(self, tree: MergeTree, part_of_extremum: dict[int, int]) -> None:
        self._tree = tree
        self._part_of_extremum = part_of_extremum
        self._opened_at: list[int] = []
        self._parent: list[int] = []
        self._extremum: list[int] = []
        self._saddle: list[int] = []
        self._closing: list[int] = []
        # The youngest arc of each component that goes on, under the name of its oldest extremum.
        self._open = {extremum: self._new_arc(extremum) for extremum in part_of_extremum}
        self._survivor: dict[int, int] = {}
        self._swallowed: list[tuple[int, int, int]] = []
        self._entry = dict(self._open)

    def merge(self, pair: int, closing: int) -> None:
        """Close the arcs of both components of a pair and open the one behind the saddle."""
        young, saddle, old = self._row(pair)
        arc = self._new_arc(old, saddle)
        for component in (young, old):
            self._close(self._open.pop(component), arc, saddle, closing)
        self._open[old] = arc
        self._survivor[young] = old

    def swallow(self, pair: int) -> None:
        """Let a component that is noise vanish in the older one."""
        young, saddle, old = self._row(pair)
        self._survivor[young] = old
        self._swallowed.append((young, saddle, old))
        if old in self._open:
            self._entry[young] = self._open[old]

    def cut(self, vertex: int, closing: int) -> None:
        """Close the arc just below a vertex, and go on with a new one."""
        component = self._component(int(self._tree.basin[vertex]))
        arc = self._open.get(component)
        if arc is None or self._opened_at[arc] == vertex:
            return
        self._open[component] = self._new_arc(self._extremum[arc], vertex)
        self._close(arc, self._open[component], vertex, closing)

    def arc_tree(self, is_of_maxima: bool, n_roots: int) -> ArcTree:
        """Return what has grown."""
        part = [self._part_of_extremum[extremum] for extremum in self._extremum]
        columns = (self._parent, part, self._extremum, self._saddle, self._closing)
        return ArcTree(is_of_maxima, n_roots, *(np.array(column, dtype=np.int64) for column in columns))

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

    def _close(self, arc: int, parent: int, saddle: int, closing: int) -> None:
        self._parent[arc], self._saddle[arc], self._closing[arc] = parent, saddle, closing
