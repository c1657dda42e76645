"""The Morse-Smale complex of a field and all that is read from it, at any level of simplification."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..surface.mesh import Floats, Ints
from ..surface.ties import ROUNDING
from .cancellation import extended_lines
from .cells import Cells, cells_of
from .cohomology import cocycles_of
from .critical_points import CriticalPoints, Kind, critical_points
from .diagram import PersistenceDiagram, persistence_diagram
from .level_sets import level_set
from .links import Links
from .merge_tree import MergeTree, merge_tree
from .pairing import Pairing, pairing_of
from .persistence import EssentialClasses, essential_classes
from .ranked_net import RankedNet, ranked_net
from .reeb import ReebGraph, build_reeb_graph
from .separatrices import Flow, Separatrices, flow_to_maxima, flow_to_minima, separatrices_of


@dataclass(frozen=True, eq=False)
class FieldTopology:
    """A field on a net with its merge trees, pairs and flow, each made when first asked for.

    Attributes
    ----------
    links : Links
        The net.
    positions : (n, 3) float64
    values : (n,) float64
    """

    links: Links
    positions: Floats
    values: Floats

    @cached_property
    def net(self) -> RankedNet:
        """The net in the order of the values."""
        return ranked_net(self.links, self.values)

    @cached_property
    def minima(self) -> MergeTree:
        """The components of the sublevel sets."""
        return merge_tree(self.net)

    @cached_property
    def maxima(self) -> MergeTree:
        """The components of the superlevel sets; the same order read downwards, so that ties are broken alike."""
        return merge_tree(self.net.reversed())

    @cached_property
    def essential(self) -> EssentialClasses:
        """The components and the loops of the surface."""
        return essential_classes(self.minima, self.maxima, cocycles_of(self.links))

    @cached_property
    def pairing(self) -> Pairing:
        """All pairs, by rising persistence."""
        return pairing_of(self.values, self.minima, self.maxima, self.essential)

    @cached_property
    def critical_points(self) -> CriticalPoints:
        """Net vertex, kind, multiplicity and value of each critical point."""
        return critical_points(self.values, self.net)

    @cached_property
    def separatrices(self) -> Separatrices:
        """The integral lines from every saddle."""
        return separatrices_of(np.union1d(self.minima.sectors.vertex, self.maxima.sectors.vertex), self.up, self.down)

    @cached_property
    def up(self) -> Flow:
        """The path of every vertex to a maximum."""
        return flow_to_maxima(self.net, self.positions, self.values)

    @cached_property
    def down(self) -> Flow:
        """The path of every vertex to a minimum."""
        return flow_to_minima(self.net, self.positions, self.values)

    @cached_property
    def flow_ends(self) -> tuple[Ints, Ints]:
        """(m,) the minimum below the lowest corner of each triangle, and the maximum above the highest."""
        corners = self.links.triangles
        heights, rows = self.net.rank[corners], np.arange(len(corners))
        return self.down.end[corners[rows, heights.argmin(axis=1)]], self.up.end[corners[rows, heights.argmax(axis=1)]]


@dataclass(frozen=True, eq=False)
class MorseSmaleComplex:
    """The Morse-Smale complex of a field, with some of its pairs cancelled.

    Cancelling forgets nothing: :meth:`simplified` starts from all pairs, whatever this complex has left.

    Attributes
    ----------
    topology : FieldTopology
    n_cancelled : int
        How many pairs are cancelled, those of least persistence.

    References
    ----------
    .. [1] Edelsbrunner, Harer, Zomorodian, "Hierarchical Morse-Smale complexes for piecewise linear 2-manifolds", 2003.
    .. [2] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, sections 3.3 and 4.2.

    Examples
    --------
    >>> morse_smale = analysis.complex
    >>> morse_smale.euler_characteristic
    2
    >>> len(morse_smale.cells) == len(morse_smale.separatrices) // 2
    True
    """

    topology: FieldTopology
    n_cancelled: int = 0

    @cached_property
    def critical_points(self) -> CriticalPoints:
        """Net vertex, kind, multiplicity and value of each critical point that is left."""
        if self.n_cancelled == 0:
            return self.topology.critical_points
        return _without_pairs(self.topology.critical_points, self.topology.pairing, self.n_cancelled)

    @property
    def euler_characteristic(self) -> int:
        """Minima - saddles + maxima, counted with multiplicity."""
        return self.critical_points.euler_characteristic

    @property
    def pairing(self) -> Pairing:
        """All pairs of the field, the cancelled ones first."""
        return self.topology.pairing

    @property
    def essential(self) -> EssentialClasses:
        """The components and the loops of the surface, which are never cancelled."""
        return self.topology.essential

    @cached_property
    def diagram(self) -> PersistenceDiagram:
        """The separated persistence diagram of the field, the cancelled pairs included."""
        known = self.topology
        return persistence_diagram(known.values, known.minima, known.maxima, known.essential)

    @cached_property
    def separatrices(self) -> Separatrices:
        """The lines between the critical points that are left; lines of cancelled saddles are parts of others."""
        if self.n_cancelled == 0:
            return self.topology.separatrices
        return extended_lines(self.topology.separatrices, self.pairing, self.n_cancelled)

    @cached_property
    def cells(self) -> Cells:
        """The pieces between the separatrices, each of which flows from one minimum to one maximum."""
        survivor = self.pairing.survivor(self.topology.links.n_vertices, self.n_cancelled)
        minimum, maximum = (survivor[ends] for ends in self.topology.flow_ends)
        return cells_of(self.topology.links, minimum, maximum, self.separatrices.paths)

    @cached_property
    def reeb_graph(self) -> ReebGraph:
        """The Reeb graph between the extrema and saddles that are left."""
        known, pairs = self.topology, self.pairing
        ends = [pairs.extremum[self.n_cancelled :], pairs.surviving_saddles(self.n_cancelled)]
        critical = np.unique(np.concatenate([*ends, self.essential.components.ravel()]))
        return build_reeb_graph(known.values, known.net, critical)

    def level_lines(self, height: float) -> list[Floats]:
        """Return the level set of the field at a height.

        Parameters
        ----------
        height : float
            In the unit of the field.

        Returns
        -------
        list of (q, 3) float64
            Polylines in the mesh's unit of length; closed ones end at the point they start from.

        Examples
        --------
        >>> len(analysis.complex.level_lines(0.0))
        5
        """
        known = self.topology
        return level_set(known.links, known.positions, known.values, height).lines()

    def simplified(self, n_pairs: int) -> "MorseSmaleComplex":
        """Return the complex with the most persistent pairs, all others cancelled.

        Parameters
        ----------
        n_pairs : int
            How many are kept.

        Returns
        -------
        MorseSmaleComplex

        Examples
        --------
        >>> sorted(analysis.complex.simplified(0).critical_points.kind.tolist())
        [0, 2]
        """
        return replace(self, n_cancelled=max(len(self.pairing) - max(n_pairs, 0), 0))

    def above(self, persistence: float) -> "MorseSmaleComplex":
        """Return the complex with the pairs of at least some persistence.

        Parameters
        ----------
        persistence : float
            In the unit of the field.

        Returns
        -------
        MorseSmaleComplex

        Examples
        --------
        >>> analysis.complex.above(np.inf).n_cancelled
        5
        """
        of_pairs = self.pairing.persistence
        margin = ROUNDING * of_pairs.max(initial=0.0)
        return self.simplified(int((of_pairs >= persistence - margin).sum()))


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
