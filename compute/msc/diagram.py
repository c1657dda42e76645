"""Persistence diagrams in the form that keeps minima and maxima apart, and what is read from them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..surface.mesh import Floats, Ints
from .merge_tree import MergeTree
from .persistence import EssentialClasses


@dataclass(frozen=True, eq=False)
class PersistenceDiagram:
    """The separated persistence diagram of a field.

    Attributes
    ----------
    points : (n, 2) float64
        (value of the extremum, value of the saddle) of every pair, by rising persistence; minima lie above the
        diagonal and maxima below it.
    components : (c, 2) float64
        (lowest, highest value) of each component of the surface.
    loops : (l, 2) float64
        (value at which the loop is first met from below, value at which it is first met from above); twice the genus
        of a closed orientable surface.

    All values have the unit of the field.

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, section 3.3.

    Examples
    --------
    >>> diagram = analysis.diagram
    >>> diagram.points.shape, diagram.components.shape, diagram.loops.shape
    ((5, 2), (1, 2), (0, 2))
    """

    points: Floats
    components: Floats
    loops: Floats

    @property
    def essential(self) -> Floats:
        """(c + l, 2) what no extremum pairs with: the components, then the loops."""
        return np.concatenate([self.components, self.loops])

    @property
    def persistence(self) -> Floats:
        """(n,) how far the two values of each pair are apart."""
        return np.abs(self.points[:, 1] - self.points[:, 0])

    @property
    def minima(self) -> Floats:
        """(n', 2) the points of minima."""
        return self.points[self.points[:, 0] < self.points[:, 1]]

    @property
    def maxima(self) -> Floats:
        """(n'', 2) the points of maxima."""
        return self.points[self.points[:, 0] > self.points[:, 1]]

    def negated(self) -> "PersistenceDiagram":
        """Return the diagram of the negated field: the points mirrored at the origin.

        Returns
        -------
        PersistenceDiagram

        Examples
        --------
        >>> len(analysis.diagram.negated().minima) == len(analysis.diagram.maxima)
        True
        """
        # Adding zero keeps a value of 0 from becoming -0.
        return PersistenceDiagram(-self.points + 0.0, -self.components[:, ::-1] + 0.0, -self.loops[:, ::-1] + 0.0)

    def intervals(self, dimension: int) -> Floats:
        """Return (birth, death) on a closed surface as ``gudhi.SimplexTree.persistence_intervals_in_dimension`` does.

        What never dies has the death inf. With boundary this holds in dimension 0 only: what maxima are paired with
        there are the relative intervals of extended persistence.

        Parameters
        ----------
        dimension : 0, 1 or 2
            Components, loops or enclosed volumes.

        Returns
        -------
        (n, 2) float64

        Examples
        --------
        >>> float(analysis.diagram.intervals(2)[0, 1])
        inf
        """
        if dimension == 0:
            return np.concatenate([self.minima, _endless(self.components[:, 0])])
        if dimension == 1:
            return np.concatenate([self.maxima[:, ::-1], _endless(self.loops[:, 0])])
        return _endless(self.components[:, 1])

    def extended_intervals(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Return (birth, death) of ordinary dimension 0, relative 1, extended 0 and extended 1, as gudhi does.

        gudhi calls the extended ones Extended+ where birth <= death, and Extended- otherwise. On a closed surface the
        ordinary ones of dimension 1 are the relative ones of dimension 1 with their ends exchanged, and so on.

        Returns
        -------
        ordinary, relative, extended_components, extended_loops : (n, 2) float64
            Each with its own number of rows.

        References
        ----------
        .. [1] Cohen-Steiner, Edelsbrunner, Harer, "Extending persistence using Poincare and Lefschetz duality", 2009.

        Examples
        --------
        >>> [len(intervals) for intervals in analysis.diagram.extended_intervals()]
        [1, 4, 1, 0]
        """
        return self.minima, self.maxima, self.components, self.loops


def persistence_diagram(
    values: Floats, minima: MergeTree, maxima: MergeTree, essential: EssentialClasses
) -> PersistenceDiagram:
    """Return the diagram of a field from its merge trees and essential classes.

    Pairs without persistence, which plateaus have, are left out.
    """
    pairs = [np.stack([tree.extremum, tree.saddle], axis=1) for tree in (minima, maxima)]
    points = values[np.concatenate(pairs)]
    points = points[points[:, 0] != points[:, 1]]
    points = points[np.argsort(np.abs(points[:, 1] - points[:, 0]), kind="stable")]
    return PersistenceDiagram(points, values[essential.components], values[essential.loops])


def size_function(diagram: PersistenceDiagram, x: ArrayLike, y: ArrayLike) -> Ints:
    """Count the components of ``{h <= y}`` that reach down to x, for x < y.

    Parameters
    ----------
    diagram : PersistenceDiagram
        Of the field h.
    x, y : float or arrays of one shape
        In the unit of the field.

    Returns
    -------
    int64 array of that shape

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, section 3.3, equation 16.

    Examples
    --------
    >>> lowest, highest = analysis.diagram.components[0]
    >>> int(size_function(analysis.diagram, lowest, highest))
    1
    """
    x, y = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
    births, deaths = diagram.intervals(0).T
    return ((births <= x[..., None]) & (deaths > y[..., None])).sum(axis=-1)


def persistence_curve(diagram: PersistenceDiagram) -> tuple[Floats, Ints]:
    """Return each persistence that occurs, rising, and the number of pairs that have at least that much.

    Parameters
    ----------
    diagram : PersistenceDiagram

    Returns
    -------
    persistence : (n,) float64
        In the unit of the field.
    n_pairs : (n,) int64

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, section 4.3.

    Examples
    --------
    >>> persistence, n_pairs = persistence_curve(analysis.diagram)
    >>> n_pairs.tolist()
    [5, 4, 3, 2, 1]
    """
    persistence = np.sort(diagram.persistence)
    return persistence, np.arange(len(persistence), 0, -1)


def _endless(births: Floats) -> Floats:
    return np.stack([births, np.full(len(births), np.inf)], axis=1)
