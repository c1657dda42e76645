"""The Morse-Smale complex: critical points, separatrices and cells at any level of simplification."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..mesh import Floats
from .cancellation import extended_lines
from .cells import Cells, cells_of
from .critical_points import CriticalPoints, Kind, critical_points
from .links import Links
from .merge_tree import MergeTree
from .pairing import Pairing
from .separatrices import Flow, Separatrices, flow_to_maxima, flow_to_minima, separatrices_of


@dataclass(frozen=True, eq=False)
class MorseSmaleComplex:
    """The Morse-Smale complex of a field on a net, with some of its pairs cancelled.

    Cancelling forgets nothing: :meth:`simplified` starts from the full complex whatever this one has left.

    Attributes
    ----------
    links : Links
        The net.
    positions : (n, 3) float64
    values : (n,) float64
    minima, maxima : MergeTree
    pairing : Pairing
    n_cancelled : int
        How many pairs are cancelled, those of least persistence.
    """

    links: Links
    positions: Floats
    values: Floats
    minima: MergeTree
    maxima: MergeTree
    pairing: Pairing
    n_cancelled: int = 0
    _original: "MorseSmaleComplex | None" = None

    @cached_property
    def critical_points(self) -> CriticalPoints:
        """Net vertex, kind, multiplicity and value of each critical point that is left."""
        if self._original is None:
            return critical_points(self.values, self.minima.rank, self.links)
        return _without_pairs(self._original.critical_points, self.pairing, self.n_cancelled)

    @property
    def euler_characteristic(self) -> int:
        """Minima - saddles + maxima, counted with multiplicity."""
        return self.critical_points.euler_characteristic

    @cached_property
    def separatrices(self) -> Separatrices:
        """The lines between the critical points that are left; lines of cancelled saddles are parts of others."""
        if self._original is None:
            saddles = np.union1d(self.minima.sectors.vertex, self.maxima.sectors.vertex)
            return separatrices_of(saddles, self._up, self._down)
        return extended_lines(self._original.separatrices, self.pairing, self.n_cancelled)

    @cached_property
    def cells(self) -> Cells:
        """The pieces between the separatrices, each of which flows from one minimum to one maximum."""
        original = self._original or self
        corners, rank = self.links.triangles, self.minima.rank
        rows = np.arange(len(corners))
        lowest, highest = corners[rows, rank[corners].argmin(axis=1)], corners[rows, rank[corners].argmax(axis=1)]
        survivor = self.pairing.survivor(self.links.n_vertices, self.n_cancelled)
        minimum, maximum = survivor[original._down.end[lowest]], survivor[original._up.end[highest]]
        return cells_of(self.links, minimum, maximum, self.separatrices.paths)

    def simplified(self, n_pairs: int) -> "MorseSmaleComplex":
        """Return the complex with the ``n_pairs`` most persistent pairs, all others cancelled."""
        n_cancelled = max(len(self.pairing) - max(n_pairs, 0), 0)
        original = self._original or self
        return replace(original, n_cancelled=n_cancelled, _original=original)

    def above(self, persistence: float) -> "MorseSmaleComplex":
        """Return the complex with all pairs of at least this persistence, in the unit of the field."""
        return self.simplified(int((self.pairing.persistence >= persistence).sum()))

    @cached_property
    def _up(self) -> Flow:
        return flow_to_maxima(self.links, self.positions, self.values, self.minima.rank)

    @cached_property
    def _down(self) -> Flow:
        return flow_to_minima(self.links, self.positions, self.values, self.minima.rank)


def _without_pairs(points: CriticalPoints, pairing: Pairing, n_cancelled: int) -> CriticalPoints:
    """Take one extremum and one saddle out for every cancelled pair."""
    kind = np.where(pairing.is_maximum, Kind.MAXIMUM, Kind.MINIMUM)[:n_cancelled]
    gone_vertex = np.concatenate([pairing.extremum[:n_cancelled], pairing.saddle[:n_cancelled]])
    gone_kind = np.concatenate([kind, np.full(n_cancelled, Kind.SADDLE)])
    gone, count = np.unique(3 * gone_vertex + gone_kind, return_counts=True)
    keys = 3 * points.vertex + points.kind
    left = points.multiplicity.copy()
    # On a boundary a saddle of pairs need not be one of the sublevel sets.
    _, row, taken = np.intersect1d(keys, gone, assume_unique=True, return_indices=True)
    left[row] = np.maximum(left[row] - count[taken], 0)
    stays = left > 0
    return CriticalPoints(points.vertex[stays], points.kind[stays], left[stays], points.value[stays])
