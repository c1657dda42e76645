"""The lowest eigenpairs by full matrices if they are small, else by one sparse factor and ARPACK.

For linear elements and small problems; `compute.fem.block_lanczos` is faster for large ones of higher order.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackError, LinearOperator, SuperLU, eigsh, splu

from ..errors import SpectrumError
from ..memory import FULL
from ..progress import Progress
from ..surface.mesh import Floats

# Shift of the factored operator, in units of 1 / area: below every eigenvalue, so that the operator is definite.
SHIFT = -4.0

# Size of SuperLU's panels, in columns; half the default suits these narrow fronts better.
PANEL_COLUMNS = 10

# Pairs that are computed before it is known how many are wanted: enough for bodies of people, whose diffusion fields
# have 8 to 11 functions, with the constant and the first that is not wanted.
FIRST_PAIRS = 13


@dataclass(frozen=True)
class WantedPairs:
    """Which of the lowest pairs are wanted.

    Attributes
    ----------
    at_most : int
        The constant counted.
    n_constant : int
        1 if the constant is among them, else 0.
    largest_ratio : float
        Pairs whose value exceeds the first that is not zero this many times are not wanted; the first of them is, since
        it shows that none is missing.
    """

    at_most: int
    n_constant: int = 0
    largest_ratio: float = np.inf

    def n_within(self, values: Floats) -> int:
        """Return how many of some values, ascending, are within the ratio."""
        if self.largest_ratio == np.inf:
            return len(values)
        return int(np.searchsorted(values, self.largest_ratio * values[self.n_constant], side="right"))

    def n_missing(self, values: Floats) -> int:
        """Return how many more pairs to compute, given the lowest values, ascending; 0 if these are enough."""
        n_known, room = len(values), self.at_most - len(values)
        if self.largest_ratio == np.inf:
            return room
        if n_known == 0:
            return min(FIRST_PAIRS, room)
        n_within = self.n_within(values)
        if n_within == n_known:
            # On a surface there are as many eigenvalues below a limit as it is high, at large (Weyl).
            limit = max(self.largest_ratio * values[self.n_constant], np.finfo(float).tiny)
            n_within = int(np.ceil(n_known * limit / max(values[-1], limit / self.at_most)))
        return min(max(n_within + 1 - n_known, 0), room)


def dense_eigenpairs(stiffness: csr_array, mass: csr_array, n_pairs: int) -> tuple[Floats, Floats]:
    """Return the smallest eigenvalues, ascending, and their functions, by full matrices."""
    values, functions = scipy.linalg.eigh(stiffness.toarray(), mass.toarray(), subset_by_index=[0, n_pairs - 1])
    return values, functions


def factored_by_columns(stiffness: csr_array, mass: csr_array) -> SuperLU:
    """Return the factor of the shifted operator in the order that SuperLU finds by itself.

    Linear elements have so few neighbours that finding an order by bisection costs more than it saves.
    """
    return _factor(stiffness, mass, permc_spec="COLAMD")


def factored_as_ordered(stiffness: csr_array, mass: csr_array) -> SuperLU:
    """Return the factor of the shifted operator, in the order of elimination that its rows have."""
    return _factor(
        stiffness,
        mass,
        permc_spec="NATURAL",
        diag_pivot_thresh=0.0,
        panel_size=PANEL_COLUMNS,
        options={"SymmetricMode": True},
    )


def _factor(stiffness: csr_array, mass: csr_array, **options: Any) -> SuperLU:
    try:
        return splu((stiffness - SHIFT * mass).tocsc(), **options)
    except MemoryError as error:
        raise SpectrumError(FULL) from error
    except RuntimeError as error:
        raise SpectrumError("The faces collapse into points or lines; merge the vertices by distance.") from error


def arpack_eigenpairs(
    stiffness: csr_array, mass: csr_array, factor: SuperLU, wanted: WantedPairs, progress: Progress
) -> tuple[Floats, Floats]:
    """Return the smallest eigenvalues, ascending, and their functions, orthonormal in the mass.

    Parameters
    ----------
    stiffness, mass : (N, N) sparse
        Semidefinite and definite, in units in which the area is 1.
    factor : SuperLU
        Of the shifted operator.
    wanted : WantedPairs

    Raises
    ------
    SpectrumError
        If there is no convergence.
    """
    values, functions = np.zeros(0), np.zeros((stiffness.shape[0], 0))
    while n_more := wanted.n_missing(values):
        # What is known is taken out of the inverse, so that the next pairs become its largest.
        solve = _Deflated(factor, values, functions, 3 * n_more, progress)
        more = _largest_of_inverse(stiffness, mass, solve, n_more)
        values, functions = np.append(values, more[0]), np.hstack([functions, more[1]])
        by_value = np.argsort(values)
        values, functions = values[by_value], functions[:, by_value]
    return values, functions


class _Deflated:
    """The inverse of the shifted operator without the pairs that are known."""

    def __init__(
        self, factor: SuperLU, values: Floats, functions: Floats, usual_solves: int, progress: Progress
    ) -> None:
        self._factor, self._functions = factor, functions
        self._inverse_values = 1 / (values - SHIFT)
        self._usual_solves, self._progress = usual_solves, progress
        self._n_solves = 0

    def __call__(self, column: Floats) -> Floats:
        self._n_solves += 1
        # ARPACK takes about three solves a pair, but nobody knows.
        self._progress(self._n_solves / (self._n_solves + self._usual_solves), "Computing eigenfunctions")
        solution = self._factor.solve(column)
        if len(self._inverse_values):
            solution -= self._functions @ (self._inverse_values * (self._functions.T @ column))
        return solution


def _largest_of_inverse(stiffness: csr_array, mass: csr_array, solve: _Deflated, n_pairs: int) -> tuple[Floats, Floats]:
    inverse = LinearOperator(stiffness.shape, matvec=solve, dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(stiffness.shape[0])
    try:
        # No tolerance but round-off: with a looser one ARPACK misses copies of multiple eigenvalues.
        return eigsh(stiffness, n_pairs, mass, sigma=SHIFT, v0=start, OPinv=inverse)
    except ArpackError as error:
        raise SpectrumError(f"The {n_pairs} eigenfunctions did not converge; repair slivers or remesh.") from error
