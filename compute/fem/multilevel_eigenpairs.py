"""The lowest eigenpairs of a large linear problem: those of a coarse one, carried from level to level and improved."""

from dataclasses import replace

import numpy as np
import scipy.linalg

from ..errors import SpectrumError
from ..progress import Progress, section
from ..surface.mesh import Floats
from .eigensolver import EigenPairs, EigenProblem, excessive
from .multigrid import Level, Multigrid, multigrid, order_in_space
from .order_choice import USUAL_FUNCTIONS
from .shift_invert import SHIFT, WantedPairs, arpack_eigenpairs

# Smaller problems are solved as fast by one factor, which needs the fewer words.
LEAST_UNKNOWNS = 20_000
# All functions are improved at a time, so many would not fit into the memory that a factor takes.
MOST_PAIRS = USUAL_FUNCTIONS + 1

# Largest relative error of an eigenvalue, as far as the steps tell: a twentieth of what linear elements may be off.
LARGEST_ERROR = 0.0002
# The first step leaves less than this part of the error, on most meshes a hundredth.
FIRST_SHARE = 0.04
MOST_STEPS = 8
# Functions whose eigenvalues have errors below this are not changed any more.
CONVERGED = 1e-7

# Pairs beyond those that are wanted: the last ones converge slowest, and are not taken.
N_GUARDS = 3


def is_for_levels(problem: EigenProblem, wanted: WantedPairs) -> bool:
    """Whether a problem is so large that it is worth while to solve coarser ones first."""
    return wanted.at_most <= MOST_PAIRS and bool(problem.is_free.sum() >= LEAST_UNKNOWNS)


def multilevel_eigenpairs(problem: EigenProblem, wanted: WantedPairs, progress: Progress) -> EigenPairs:
    """Return about the pairs that `linear_eigenpairs` returns, with eigenvalues to some 1e-4 or better.

    Parameters
    ----------
    problem : EigenProblem
        With linear elements.
    wanted : WantedPairs
    progress : Progress

    Raises
    ------
    SpectrumError
        If there is no convergence.
    numpy.linalg.LinAlgError
        If functions fall together.

    References
    ----------
    .. [1] Knyazev and Neymeyr, "A geometric theory for preconditioned inverse iteration III", Linear Algebra and its
       Applications 2003.
    .. [2] Brandt, McCormick, Ruge, "Multigrid methods for differential eigenproblems", SIAM J. Sci. Stat. Comput. 1983.
    """
    progress(0.0, "Coarsening")
    unknowns = np.flatnonzero(problem.is_free)
    unknowns = unknowns[order_in_space(problem.space.nodes[unknowns])]
    levels = multigrid(*problem.matrices(unknowns), problem.space.nodes[unknowns])
    computed = replace(excessive(wanted), at_most=wanted.at_most + N_GUARDS)
    values, of_unknowns = _improved(levels, computed, wanted, section(progress, 0.4, 1.0))
    values = values[: wanted.at_most]
    if wanted.n_missing(values):
        raise SpectrumError("A coarser mesh has other eigenfunctions.")
    functions = np.zeros((problem.space.n_unknowns, len(values)))
    functions[unknowns] = of_unknowns[:, : len(values)]
    return values, functions


def _improved(
    levels: Multigrid, computed: WantedPairs, wanted: WantedPairs, progress: Progress
) -> tuple[Floats, Floats]:
    """Return pairs of a level, from those of the next coarser one."""
    level = levels.level
    if levels.coarser is None:
        return arpack_eigenpairs(level.stiffness, level.mass, level.factor, computed, progress)
    functions = _improved(levels.coarser.levels, computed, wanted, section(progress, 0.0, 0.2))[1]
    values, functions = _ritz_pairs(level, levels.coarser.prolongation @ functions)
    before = 0.0
    for step in range(MOST_STEPS):
        progress(0.2 + 0.8 * step / MOST_STEPS, "Computing eigenfunctions")
        residuals = level.mass @ functions
        residuals *= -values
        residuals += level.stiffness @ functions
        changes = levels.approximate_inverse(residuals)
        errors = np.einsum("ij,ij->j", residuals, changes) / (values - SHIFT)
        del residuals
        values, functions = _improved_pairs(level, values, functions, changes[:, errors > CONVERGED])
        worst = float(errors[: wanted.n_within(values)].max())
        share = worst / before if step else FIRST_SHARE
        # The error before this step was about ``worst``, and each step leaves that share of it.
        if worst * share <= LARGEST_ERROR * (1 - share):
            return values, functions
        before = worst
    raise SpectrumError("The eigenfunctions did not converge; look for slivers, or remesh the surface.")


def _ritz_pairs(level: Level, functions: Floats) -> tuple[Floats, Floats]:
    """Return the best eigenvalues, ascending, and functions among what some span."""
    energy, mass = (functions.T @ (matrix @ functions) for matrix in (level.stiffness, level.mass))
    values, coefficients = scipy.linalg.eigh(energy, mass)
    return values, functions @ coefficients


def _improved_pairs(level: Level, values: Floats, functions: Floats, changes: Floats) -> tuple[Floats, Floats]:
    """Return as many of the best pairs among what functions, themselves best, and changes of them span."""
    n_pairs = len(values)
    energy, mass = (
        _bordered(diagonal, functions, changes, matrix @ changes)
        for diagonal, matrix in ((values, level.stiffness), (np.ones(n_pairs), level.mass))
    )
    # Changes are small, so they are measured by their own size.
    size = 1 / np.sqrt(np.diag(mass))
    energy, mass = (size[:, None] * products * size for products in (energy, mass))
    values, coefficients = scipy.linalg.eigh(energy, mass, subset_by_index=[0, n_pairs - 1])
    coefficients *= size[:, None]
    functions = functions @ coefficients[:n_pairs]
    functions += changes @ coefficients[n_pairs:]
    return values, functions


def _bordered(diagonal: Floats, functions: Floats, changes: Floats, image: Floats) -> Floats:
    """Return the products of functions and changes with their images, given those of the functions alone."""
    mixed = functions.T @ image
    return np.block([[np.diag(diagonal), mixed], [mixed.T, changes.T @ image]])
