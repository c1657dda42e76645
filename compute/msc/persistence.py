"""Persistence pairs of a field: extrema with saddles, and the saddles of handles with each other."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..surface.mesh import Ints
from .cohomology import Cocycles, reduce_vector
from .merge_tree import MergeTree, ends_of_paths


@dataclass(frozen=True, eq=False)
class EssentialClasses:
    """The classes that no sublevel set ever loses: the components and the loops of the net itself.

    Attributes
    ----------
    components : (c, 2) int64
        Lowest and highest vertex of each component.
    loops : (l, 2) int64
        Extended persistence: the saddle at which a loop first lies in a sublevel set, and the saddle at which it first
        lies in a superlevel set. On a closed orientable surface every pair occurs a second time with its ends
        exchanged: around a handle and along it.

    References
    ----------
    .. [1] Cohen-Steiner, Edelsbrunner, Harer, "Extending persistence using Poincare and Lefschetz duality", 2009.
    """

    components: Ints
    loops: Ints

    @property
    def handles(self) -> Ints:
        """(h, 2) the loops as pairs of saddles without order, the first row of each two that are mirrored.

        A closed orientable surface of genus g has 2 g saddles that no extremum pairs with, in g rows.
        """
        left: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for first, second in self.loops.tolist():
            pair = (min(first, second), max(first, second))
            left.setdefault(pair, []).append((first, second))
        rows = [row for rows in left.values() for row in _without_mirrored(rows)]
        return np.array(sorted(rows), dtype=np.int64).reshape(-1, 2)


def essential_classes(minima: MergeTree, maxima: MergeTree, cocycles: Cocycles) -> EssentialClasses:
    """Return the essential classes of a field.

    The loops of the net form a vector space, and the loops in sublevel sets a rising sequence of its subspaces; so do
    those in superlevel sets. Two such sequences always have a basis in common, and its members are the pairs.

    Parameters
    ----------
    minima, maxima : MergeTree
        Of the sweep upwards and of the sweep downwards over the same order.
    cocycles : Cocycles
        A basis for the net.
    """
    born, rising = _independent_loops(minima, cocycles)
    died, falling = _independent_loops(maxima, cocycles)
    loops = [(born[place], died[row]) for row, place in enumerate(_common_basis(rising, falling))]
    return EssentialClasses(_component_ends(minima, maxima), np.array(loops, dtype=np.int64).reshape(-1, 2))


def _component_ends(minima: MergeTree, maxima: MergeTree) -> Ints:
    """Return the lowest and the highest vertex of each component, the lowest component first."""
    root = np.arange(len(minima.rank))
    root[minima.extremum] = minima.elder
    lowest = ends_of_paths(root)[minima.basin[maxima.roots]]
    ends = np.stack([lowest, maxima.roots], axis=1)
    return ends[np.argsort(minima.rank[lowest])]


def _independent_loops(tree: MergeTree, cocycles: Cocycles) -> tuple[list[int], list[int]]:
    """Return the saddles at which the sweep meets a new loop of the net, and the cocycles each loop crosses oddly."""
    born: list[int] = []
    loops: list[int] = []
    echelon: dict[int, tuple[int, int]] = {}
    for saddle, loop in _closed_loops(tree, cocycles):
        rest, _ = reduce_vector(loop, 0, echelon)
        if rest:
            echelon[rest.bit_length()] = rest, 0
            born.append(saddle)
            loops.append(loop)
    return born, loops


def _closed_loops(tree: MergeTree, cocycles: Cocycles) -> Iterator[tuple[int, int]]:
    """Yield, in the order of the sweep, each saddle that closes a loop and the cocycles that it crosses oddly."""
    if cocycles.betti[1] == 0:
        return
    sectors = tree.sectors
    crossed = cocycles.along(sectors.vertex, sectors.lowest) ^ _crossed_on_descent(tree, cocycles)[sectors.lowest]
    forest = _LoopForest()
    rows = zip(sectors.vertex.tolist(), tree.basin[sectors.lowest].tolist(), _as_integers(crossed), strict=True)
    first_saddle, first_minimum, first_path = -1, -1, 0
    for saddle, minimum, path in rows:
        if saddle != first_saddle:
            first_saddle, first_minimum, first_path = saddle, minimum, path
        elif loop := forest.join(first_minimum, minimum, first_path ^ path):
            yield saddle, loop


class _LoopForest:
    """Minima that are joined by paths, with the cocycles crossed from each to the one it was joined to."""

    def __init__(self) -> None:
        self._above: dict[int, tuple[int, int]] = {}

    def join(self, first: int, second: int, path: int) -> int:
        """Join two minima by a path; where they are joined already, return what the loop crosses."""
        first_root, first_path = self._root(first)
        second_root, second_path = self._root(second)
        loop = path ^ first_path ^ second_path
        if first_root == second_root:
            return loop
        self._above[first_root] = second_root, loop
        return 0

    def _root(self, minimum: int) -> tuple[int, int]:
        visited, path = [], 0
        while above := self._above.get(minimum):
            visited.append((minimum, path))
            path ^= above[1]
            minimum = above[0]
        for node, before in visited:
            self._above[node] = minimum, path ^ before
        return minimum, path


def _crossed_on_descent(tree: MergeTree, cocycles: Cocycles) -> NDArray[np.uint64]:
    """(n, w) the cocycles that are crossed an odd number of times on the descent from each vertex."""
    target = tree.descent
    crossed = cocycles.along(np.arange(len(target)), target)
    while not np.array_equal(target, further := target[target]):
        crossed = crossed ^ crossed[target]
        target = further
    return crossed


def _as_integers(rows: NDArray[np.uint64]) -> list[int]:
    return [int.from_bytes(row.tobytes(), sys.byteorder) for row in np.ascontiguousarray(rows[:, ::_WORD_ORDER])]


# The order in which 64-bit words are read, so that the first one holds the lowest bits of a long integer.
_WORD_ORDER = 1 if sys.byteorder == "little" else -1


def _common_basis(rising: list[int], falling: list[int]) -> list[int]:
    """Return for each falling loop the place of the rising loop that it is paired with.

    Each falling loop is written in rising ones and changed by those before it until its last place is its own.
    """
    echelon: dict[int, tuple[int, int]] = {}
    for place, loop in enumerate(rising):
        rest, history = reduce_vector(loop, 1 << place, echelon)
        echelon[rest.bit_length()] = rest, history
    taken: dict[int, tuple[int, int]] = {}
    places = []
    for loop in falling:
        _, coordinates = reduce_vector(loop, 0, echelon)
        coordinates, _ = reduce_vector(coordinates, 0, taken)
        taken[coordinates.bit_length()] = coordinates, 0
        places.append(coordinates.bit_length() - 1)
    return places


def _without_mirrored(rows: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Take out one row for every row with its ends exchanged."""
    upward = [row for row in rows if row[0] <= row[1]]
    downward = [row for row in rows if row[0] > row[1]]
    return upward if len(upward) >= len(downward) else downward
