"""Block Lanczos iteration for the smallest eigenvalues of a factored pencil, started from a good guess.

The factor solves four right hand sides in the time of two alone, and a start that holds little but the functions looked
for saves a fifth of the steps. Together they halve the time of ARPACK.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.sparse import csr_array

from ..errors import SpectrumError
from ..progress import Progress
from ..surface.mesh import Floats

# The first look at the true residuals is worth taking when the recurrence promises this part of the tolerance.
PROMISED = 0.1
# The recurrence is asked first when the basis has this many times the number of pairs, next when it has grown by this
# fraction, and from then on after this part of the steps that it would still take at the same pace.
FIRST_LOOK, NEXT_LOOK, PACE = 2, 0.1, 0.7

# Room for the basis: this many times the number of pairs, and as many blocks beyond that. Three times the pairs and
# three blocks are usual.
MOST_COLUMNS = 4
MOST_BLOCKS = 16

# Random mixtures of the residuals that are measured instead of all of them.
N_MIXTURES = 4


@dataclass(frozen=True, eq=False)
class Pencil:
    """The problem ``stiffness @ u = value * mass @ u``, and the inverse of stiffness - shift * mass."""

    stiffness: csr_array
    mass: csr_array
    shift: float
    solve: Callable[[Floats], Floats]


@dataclass(eq=False)
class _Krylov:
    """The basis so far, as rows, and the projected inverse, which is block tridiagonal.

    Attributes
    ----------
    rows : (capacity, N) float64
        The first ``size`` rows are orthonormal in the mass.
    projected : (capacity, capacity) float64
        The inverse on that basis.
    """

    rows: Floats
    projected: Floats
    size: int = 0


def smallest_eigenpairs(
    pencil: Pencil, start: Floats, n_pairs: int, tolerance: float, progress: Progress
) -> tuple[Floats, Floats]:
    """Return the smallest eigenvalues, ascending, and their functions, orthonormal in the mass.

    Parameters
    ----------
    pencil : Pencil
        Stiffness semidefinite, mass definite, N rows; the shift below every eigenvalue.
    start : (N, b) float
        First block; no eigenvalue may be more than b-fold.
    n_pairs : int
    tolerance : float
        Largest length of a residual in the norm of the inverse, over the square root of the eigenvalue.

    Raises
    ------
    SpectrumError
        If the pairs do not converge.
    numpy.linalg.LinAlgError
        If the start or the Krylov space is exhausted.
    """
    n_rows, width = start.shape
    capacity = MOST_COLUMNS * n_pairs + MOST_BLOCKS * width
    krylov = _Krylov(np.empty((capacity, n_rows)), np.zeros((capacity, capacity)))
    block, weighted, _ = _orthonormal(start.T, pencil.mass)
    promised, looks, look_at = PROMISED * tolerance, [], FIRST_LOOK * n_pairs
    while krylov.size + 2 * width <= capacity:
        block, weighted, coupling = _extend(krylov, block, weighted, pencil)
        progress(min(krylov.size / (MOST_COLUMNS * n_pairs), 1.0), "Computing eigenfunctions")
        if krylov.size < look_at:
            continue
        inverse_values, coefficients = _ritz(krylov, n_pairs)
        worst = _promised_residual(inverse_values, coefficients, coupling)
        if worst <= promised:
            values = pencil.shift + 1 / inverse_values
            functions = krylov.rows[: krylov.size].T @ coefficients
            if _true_residual(pencil, values, functions) <= tolerance:
                return values, functions
            promised /= 3
        looks.append((krylov.size, float(np.log(worst))))
        look_at = _next_look(looks, float(np.log(promised)))
    raise SpectrumError("The eigenfunctions did not converge; look for slivers, or remesh the surface.")


def _extend(krylov: _Krylov, block: Floats, weighted: Floats, pencil: Pencil) -> tuple[Floats, Floats, Floats]:
    """Add a block to the basis, and return the next one, its product with the mass, and its coupling to this one."""
    width, first = len(block), krylov.size
    present = slice(first, first + width)
    before = slice(max(first - width, 0), first)
    krylov.rows[present] = block
    krylov.size = first + width
    image = np.ascontiguousarray(pencil.solve(weighted.T).T)
    diagonal = weighted @ image.T
    krylov.projected[present, present] = 0.5 * (diagonal + diagonal.T)
    image -= diagonal.T @ block
    image -= krylov.projected[present, before] @ krylov.rows[before]
    # In exact arithmetic nothing is left along the rest of the basis; without this step round-off would bring back
    # copies of functions that have already converged.
    known = krylov.rows[: krylov.size]
    image -= (known @ (pencil.mass @ image.T)).T @ known
    following, weighted, coupling = _orthonormal(image, pencil.mass)
    after = slice(krylov.size, krylov.size + width)
    krylov.projected[after, present], krylov.projected[present, after] = coupling, coupling.T
    return following, weighted, coupling


def _orthonormal(rows: Floats, mass: csr_array) -> tuple[Floats, Floats, Floats]:
    """Return orthonormal rows with the same span, their products with the mass, and the coefficients back."""
    weighted = (mass @ np.ascontiguousarray(rows.T)).T
    coefficients = scipy.linalg.cholesky(rows @ weighted.T, lower=True)
    inverse = scipy.linalg.solve_triangular(coefficients, np.eye(len(rows)), lower=True)
    return inverse @ rows, inverse @ weighted, coefficients.T


def _ritz(krylov: _Krylov, n_pairs: int) -> tuple[Floats, Floats]:
    """Return the largest Ritz values of the inverse, descending, and their coefficients."""
    size = krylov.size
    n_found = min(n_pairs, size)
    values, vectors = scipy.linalg.eigh(krylov.projected[:size, :size], subset_by_index=[size - n_found, size - 1])
    return values[::-1], vectors[:, ::-1]


def _promised_residual(inverse_values: Floats, coefficients: Floats, coupling: Floats) -> float:
    """Return the largest relative residual of the inverse that the recurrence promises."""
    width = len(coupling)
    residuals = np.linalg.norm(coupling @ coefficients[-width:], axis=0)
    return float(np.max(residuals / inverse_values))


def _next_look(looks: list[tuple[int, float]], goal: float) -> int:
    """Return the size of the basis at which its Ritz values are worth computing again.

    On a large basis they cost as much as many steps.

    Parameters
    ----------
    looks : list of (size, logarithm of the residual)
        So far.
    goal : float
        Logarithm of the residual that is wanted.
    """
    size, residual = looks[-1]
    growth = NEXT_LOOK * size
    if len(looks) > 1 and residual < looks[-2][1]:
        pace = (looks[-2][1] - residual) / (size - looks[-2][0])
        growth = min(growth, PACE * (residual - goal) / pace)
    return int(size + growth)


def _true_residual(pencil: Pencil, values: Floats, functions: Floats) -> float:
    """Return the length of the true residuals in the norm of the inverse, over the root of the values.

    It is measured on a few mixtures with random signs, whose squared lengths are on average the sum over all functions.
    Where the factor is too poor to be believed, which its own product with the operator tells, the answer is infinite.
    """
    signs = np.random.default_rng(0).choice([-1.0, 1.0], size=(len(values), N_MIXTURES))
    mixed = signs / np.sqrt(np.maximum(values, values[-1] * 1e-3))[:, None]
    residuals = pencil.stiffness @ (functions @ mixed) - pencil.mass @ (functions @ (values[:, None] * mixed))
    corrections = np.ascontiguousarray(pencil.solve(residuals))
    image = pencil.stiffness @ corrections - pencil.shift * (pencil.mass @ corrections)
    is_trusted = np.linalg.norm(image - residuals) <= 0.1 * np.linalg.norm(residuals)
    squared = np.einsum("ij,ij->j", residuals, corrections)
    return float(np.sqrt(np.abs(squared).max())) if is_trusted else np.inf
