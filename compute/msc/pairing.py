"""All pairs of a field in the order in which they are cancelled."""

from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Bools, Floats, Ints
from ..surface.ties import evened
from .merge_tree import MergeTree, ends_of_paths
from .persistence import EssentialClasses


@dataclass(frozen=True, eq=False)
class Pairing:
    """All pairs of a field, by rising persistence.

    Attributes
    ----------
    extremum, saddle, elder : (n,) int64
        Net vertices; cancelling leads what ended at the extremum on to the elder one.
    persistence : (n,) float64
    is_maximum : (n,) bool
    essential : EssentialClasses
    """

    extremum: Ints
    saddle: Ints
    elder: Ints
    persistence: Floats
    is_maximum: Bools
    essential: EssentialClasses

    def __len__(self) -> int:
        return len(self.extremum)

    def surviving_saddles(self, n_cancelled: int) -> Ints:
        """Return the saddles that are in a pair that is left, or at a handle."""
        return np.union1d(self.saddle[n_cancelled:], self.essential.loops.ravel())

    def survivor(self, n_vertices: int, n_cancelled: int) -> Ints:
        """(n_vertices,) the extremum that each extremum has become; other vertices stand for themselves."""
        heir = np.arange(n_vertices)
        heir[self.extremum[:n_cancelled]] = self.elder[:n_cancelled]
        return ends_of_paths(heir)


def pairing_of(values: Floats, minima: MergeTree, maxima: MergeTree, essential: EssentialClasses) -> Pairing:
    """Order the pairs of both merge trees by persistence."""
    extremum = np.concatenate([minima.extremum, maxima.extremum])
    saddle = np.concatenate([minima.saddle, maxima.saddle])
    elder = np.concatenate([minima.elder, maxima.elder])
    is_maximum = np.repeat([False, True], [len(minima.extremum), len(maxima.extremum)])
    persistence = evened(np.abs(values[extremum] - values[saddle]))
    # Between equal values the order of the vertices decides which pair is nested in which.
    steps = np.abs(minima.rank[extremum] - minima.rank[saddle])
    order = np.lexsort((steps, persistence))
    return Pairing(
        extremum=extremum[order],
        saddle=saddle[order],
        elder=elder[order],
        persistence=persistence[order],
        is_maximum=is_maximum[order],
        essential=essential,
    )
