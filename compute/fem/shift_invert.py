"""The lowest eigenpairs by full matrices if they are small, else by one sparse factor and ARPACK.

For linear elements and small problems; `compute.fem.block_lanczos` is faster for large ones of higher order.
"""

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
    stiffness: csr_array, mass: csr_array, factor: SuperLU, n_pairs: int, progress: Progress
) -> tuple[Floats, Floats]:
    """Return the smallest eigenvalues, ascending, and their functions, orthonormal in the mass.

    Parameters
    ----------
    stiffness, mass : (N, N) sparse
        Semidefinite and definite, in units in which the area is 1.
    factor : SuperLU
        Of the shifted operator.
    n_pairs : int

    Raises
    ------
    SpectrumError
        If there is no convergence.
    """
    n_solves = 0

    def solve(column: Floats) -> Floats:
        nonlocal n_solves
        n_solves += 1
        # ARPACK takes about three solves a pair, but nobody knows.
        progress(n_solves / (n_solves + 3 * n_pairs), "Computing eigenfunctions")
        return factor.solve(column)

    inverse = LinearOperator(stiffness.shape, matvec=solve, dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(stiffness.shape[0])
    try:
        # No tolerance but round-off: with a looser one ARPACK misses copies of multiple eigenvalues.
        values, functions = eigsh(stiffness, n_pairs, mass, sigma=SHIFT, v0=start, OPinv=inverse)
    except ArpackError as error:
        raise SpectrumError(f"The {n_pairs} eigenfunctions did not converge; repair slivers or remesh.") from error
    by_value = np.argsort(values)
    return values[by_value], functions[:, by_value]
