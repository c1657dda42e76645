"""Coarser and coarser versions of a problem on a mesh, and the approximate inverse that they make together."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.linalg import SuperLU

from ..errors import SpectrumError
from ..surface.mesh import Floats, Ints
from .aggregation import aggregates, carrying, centres
from .shift_invert import SHIFT, factored_by_columns

# Problems of at most this many unknowns are factored.
COARSEST_UNKNOWNS = 6000

# A level has about an eighth of the unknowns of the finer one; with more than this part nothing would be won.
LARGEST_SHARE = 0.5

# Binary digits of a place along each axis, by which places are sorted.
N_DIGITS = 10

# The smoother damps what oscillates faster than this part of the fastest.
SMOOTHED_SHARE = 0.15
# Steps of power iteration towards the fastest, and how far they are from it at most.
N_POWER_STEPS = 20
POWER_MARGIN = 1.1

# An approximate inverse needs no more digits, and is made in two thirds of the time with these.
Floats32 = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class _Rough:
    """What is needed of a level for the approximate inverse, in few digits."""

    shifted: csr_array
    inverse_diagonal: Floats32
    prolongation: csr_array
    restriction: csr_array


@dataclass(frozen=True, eq=False)
class Level:
    """A problem ``stiffness @ u = value * mass @ u`` on one level.

    Attributes
    ----------
    stiffness, mass : (N, N) sparse
        With entries at the same places; semidefinite and definite, in units in which the area is 1.
    positions : (N, 3) float64
        Places of the unknowns.
    """

    stiffness: csr_array
    mass: csr_array
    positions: Floats

    @property
    def n_unknowns(self) -> int:
        """Number of unknowns N."""
        return len(self.positions)

    @cached_property
    def factor(self) -> SuperLU:
        """The factor of the operator to be inverted."""
        return factored_by_columns(self.stiffness, self.mass)

    def coarser(self) -> tuple["Level", csr_array]:
        """Return the next level, and (N, n) its functions as ones of this."""
        aggregate = aggregates(self.stiffness)
        coarse_positions = centres(aggregate, self.positions)
        up = carrying(self.stiffness, aggregate, self.positions, coarse_positions)
        # Real and imaginary part share the work.
        stiffness = self.stiffness
        both = csr_array((stiffness.data + 1j * self.mass.data, stiffness.indices, stiffness.indptr))
        both = up.T.tocsr() @ (both @ up)
        # Sorted here once, so that nothing later sorts one part without the other.
        both.sort_indices()
        return Level(both.real.copy(), both.imag.copy(), coarse_positions), up


@dataclass(frozen=True, eq=False)
class Multigrid:
    """A level with the coarser ones below it.

    Attributes
    ----------
    level : Level
        N unknowns.
    coarser : Coarser, optional
        None on the last level.
    """

    level: Level
    coarser: "Coarser | None" = None

    def approximate_inverse(self, columns: Floats) -> Floats:
        """Return about what the inverse of stiffness - SHIFT * mass makes of (N, k) columns: symmetric and definite.

        References
        ----------
        .. [1] Vanek, Mandel, Brezina, "Algebraic multigrid by smoothed aggregation for second and fourth order elliptic
           problems", Computing 1996.
        """
        if self.coarser is None:
            return self.level.factor.solve(columns)
        return self._cycle(columns.astype(np.float32)).astype(np.float64)

    def _cycle(self, columns: Floats32) -> Floats32:
        if self.coarser is None:
            return self.level.factor.solve(columns.astype(np.float64)).astype(np.float32)
        rough = self._rough
        result = self._smoothed(columns, None)
        rest = columns - rough.shifted @ result
        result += rough.prolongation @ self.coarser.levels._cycle(rough.restriction @ rest)
        return self._smoothed(columns, result)

    def _smoothed(self, columns: Floats32, start: Floats32 | None) -> Floats32:
        """Return a solution after two Chebyshev steps, which damp what oscillates."""
        rough, fastest = self._rough, self._fastest
        centre, half = 0.5 * (1 + SMOOTHED_SHARE) * fastest, 0.5 * (1 - SMOOTHED_SHARE) * fastest
        rest = columns if start is None else columns - rough.shifted @ start
        step = rest * (rough.inverse_diagonal / np.float32(centre))[:, None]
        result = step if start is None else start + step
        length = 1 / (centre - 0.5 * half**2 / centre)
        rest = columns - rough.shifted @ result
        rest *= (rough.inverse_diagonal * np.float32(length))[:, None]
        rest += result
        rest += step * np.float32(0.5 * (half / centre) ** 2)
        return rest

    @cached_property
    def _rough(self) -> _Rough:
        assert self.coarser is not None
        shifted, up = self._shifted, self.coarser.prolongation.astype(np.float32)
        return _Rough(shifted.astype(np.float32), (1 / shifted.diagonal()).astype(np.float32), up, up.T.tocsr())

    @property
    def _shifted(self) -> csr_array:
        shifted = self.level.stiffness.copy()
        shifted.data -= SHIFT * self.level.mass.data
        return shifted

    @cached_property
    def _fastest(self) -> float:
        """About the largest eigenvalue of the operator over its diagonal, from above."""
        rough = self._rough
        column = np.random.default_rng(0).standard_normal(self.level.n_unknowns, dtype=np.float32)
        for _ in range(N_POWER_STEPS):
            column = rough.inverse_diagonal * (rough.shifted @ (column / np.linalg.norm(column)))
        return POWER_MARGIN * float(np.linalg.norm(column))


@dataclass(frozen=True, eq=False)
class Coarser:
    """The levels below one.

    Attributes
    ----------
    prolongation : (N, n) sparse
        The functions of the next level as ones of the one above it.
    levels : Multigrid
        From the next level on.
    """

    prolongation: csr_array
    levels: Multigrid


def multigrid(stiffness: csr_array, mass: csr_array, positions: Floats) -> Multigrid:
    """Return a problem with coarser ones, down to one that can be factored; see `Level`.

    Raises
    ------
    SpectrumError
        If so little hangs together that a coarser problem has nearly as many unknowns.
    """
    return _from(Level(stiffness, mass, positions))


def _from(level: Level) -> Multigrid:
    if level.n_unknowns <= COARSEST_UNKNOWNS:
        return Multigrid(level)
    coarser, prolongation = level.coarser()
    if coarser.n_unknowns > LARGEST_SHARE * level.n_unknowns:
        raise SpectrumError("The mesh hangs together by slivers; merge the vertices by distance, or remesh it.")
    return Multigrid(level, Coarser(prolongation, _from(coarser)))


def order_in_space(positions: Floats) -> Ints:
    """Return (N,) an order of places in which neighbours follow one another, whatever order they come in.

    So aggregates do not depend on the numbering of vertices, and neighbours are near in memory, too.

    References
    ----------
    .. [1] Morton, "A computer oriented geodetic data base", IBM 1966.
    """
    low = positions.min(axis=0)
    extent = max(float((positions - low).max()), np.finfo(float).tiny)
    cells = ((positions - low) * ((1 << N_DIGITS) - 1) / extent).astype(np.int64)
    key = np.zeros(len(positions), dtype=np.int64)
    for digit in range(N_DIGITS):
        for axis in range(3):
            key |= (cells[:, axis] >> digit & 1) << (3 * digit + axis)
    return np.argsort(key, kind="stable")
