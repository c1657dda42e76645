"""The lowest eigenpairs in a finite element space: linear elements first, and from there to the order asked for."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import SuperLU

from ..errors import SpectrumError
from ..progress import Progress, section
from ..surface.mesh import Bools, Floats, Ints
from .assembly import Metric, assemble, element_mass, element_stiffness, metric
from .block_lanczos import Pencil, smallest_eigenpairs
from .nested_dissection import bisect_triangles, elimination_order
from .shift_invert import (
    SHIFT,
    WantedPairs,
    arpack_eigenpairs,
    dense_eigenpairs,
    factored_as_ordered,
    factored_by_columns,
)
from .space import FunctionSpace, function_space

# Error of the eigenfunctions, in the sense of `compute.fem.block_lanczos`; eigenvalues have its square.
TOLERANCE = 1e-6

# Below this many unknowns ARPACK is as fast as the block iteration with its linear start.
BLOCK_UNKNOWNS = 5000

# Smaller problems, and those where a good part of all functions is wanted, are solved as full matrices.
DENSE_UNKNOWNS = 400
DENSE_SHARE = 1 / 5

# A richer space cannot have larger eigenvalues (Courant and Fischer): one that exceeds the linear value of its number
# by more than this part of the largest betrays that another was missed.
ROUNDING = 1e-9

# Functions that are iterated at a time; more where symmetry makes eigenvalues multiple, which linear elements show.
LEAST_WIDTH = 4
SAME_VALUE = 1e-3

# Eigenvalues of linear elements are too large; up to this much when they decide how many functions are needed.
LINEAR_EXCESS = 1.1

# (k,) eigenvalues in units of 1 / area, ascending, and (N, k) functions, orthonormal with the area as unit.
EigenPairs = tuple[Floats, Floats]


@dataclass(frozen=True, eq=False)
class EigenProblem:
    """The Laplace-Beltrami operator in a finite element space, in units in which the area is 1.

    Attributes
    ----------
    space : FunctionSpace
        N unknowns.
    is_free : (N,) bool
        Whether an unknown is solved for; the functions are zero at the others.
    metric : Metric
        Shape of the triangles.
    leaves : (T,) int, optional
        Codes from `bisect_triangles`. Without them the factorization finds an order of elimination by itself.
    """

    space: FunctionSpace
    is_free: Bools
    metric: Metric
    leaves: Ints | None

    @cached_property
    def linear(self) -> "EigenProblem":
        """The same with linear elements."""
        space = function_space(self.space.mesh, 1)
        return EigenProblem(space, self.is_free[: space.n_unknowns], self.metric, self.leaves)

    @cached_property
    def elimination_order(self) -> Ints:
        """The free unknowns; if the leaves are known, in an order of elimination that keeps factors sparse."""
        if self.leaves is None:
            return np.flatnonzero(self.is_free)
        unknowns = elimination_order(self.space.elements, self.leaves, self.space.n_unknowns)
        return unknowns[self.is_free[unknowns]]

    def matrices(self, unknowns: Ints) -> tuple[csr_array, csr_array]:
        """Return stiffness and mass of some unknowns, in their order."""
        row = np.full(self.space.n_unknowns, len(unknowns))
        row[unknowns] = np.arange(len(unknowns))
        stiffness, mass = (
            of_element(self.metric, self.space.element) for of_element in (element_stiffness, element_mass)
        )
        # Real and imaginary part of one matrix share the work. All other unknowns share one more row, which is cut off.
        both = assemble(row[self.space.elements], stiffness + 1j * mass, len(unknowns) + 1)[:-1, :-1]
        return both.real.copy(), both.imag.copy()

    def factored(self, stiffness: csr_array, mass: csr_array) -> SuperLU:
        """Return the factor of the shifted operator, given the matrices in the order of elimination."""
        factored = factored_by_columns if self.leaves is None else factored_as_ordered
        return factored(stiffness, mass)


def eigen_problem(space: FunctionSpace, is_free: Bools) -> EigenProblem:
    """Return the eigenvalue problem for the free unknowns of a space."""
    # Linear elements alone are solved before the bisection pays.
    leaves = bisect_triangles(space.mesh) if space.element.order > 1 else None
    return EigenProblem(space, is_free, metric(space.mesh), leaves)


def lowest_eigenpairs(
    problem: EigenProblem, wanted: WantedPairs, progress: Progress, start: EigenPairs | None = None
) -> EigenPairs:
    """Return the smallest eigenvalues and their functions.

    Parameters
    ----------
    problem : EigenProblem
    wanted : WantedPairs
        How many.
    progress : Progress
    start : EigenPairs, optional
        Those of linear elements, by :func:`linear_eigenpairs`; computed where they are needed if None.

    Returns
    -------
    values : (k,) float64
        In units of 1 / area, ascending.
    functions : (N, k) float64
        Orthonormal with the area as unit.

    Raises
    ------
    SpectrumError
        If the iteration does not converge.
    """
    if problem.space.element.order == 1 or problem.is_free.sum() < BLOCK_UNKNOWNS:
        return _plain_eigenpairs(problem, wanted, progress)
    if wanted.at_most > DENSE_SHARE * problem.linear.is_free.sum():
        return _plain_eigenpairs(problem, wanted, progress)
    values, functions = start or linear_eigenpairs(problem.linear, wanted, section(progress, 0.0, 0.15))
    # One function more than needed shows that none is missing.
    n_pairs = min(excessive(wanted).n_within(values) + 1, len(values))
    width = max(LEAST_WIDTH, _multiplicity(values[:n_pairs]) + 1)
    mixed = functions[:, :n_pairs] @ _mixture(n_pairs, width)
    return _block_eigenpairs(problem, mixed, values[:n_pairs], section(progress, 0.15, 1.0))


def linear_eigenpairs(problem: EigenProblem, wanted: WantedPairs, progress: Progress) -> EigenPairs:
    """Return the pairs of linear elements from which those of a higher order are found that are wanted."""
    return _plain_eigenpairs(problem, excessive(wanted), progress)


def excessive(wanted: WantedPairs) -> WantedPairs:
    """Return the pairs of linear elements among which are those of a higher order that are wanted."""
    return replace(wanted, largest_ratio=LINEAR_EXCESS * wanted.largest_ratio)


def _multiplicity(values: Floats) -> int:
    """Return the size of the largest group of eigenvalues that follow one another closely."""
    ends = np.flatnonzero(np.append(np.diff(values) > SAME_VALUE * values[1:], True))
    return int(np.diff(ends, prepend=-1).max())


def _mixture(n_functions: int, width: int) -> Floats:
    return np.random.default_rng(0).standard_normal((n_functions, width))


def _plain_eigenpairs(problem: EigenProblem, wanted: WantedPairs, progress: Progress) -> EigenPairs:
    """Return the lowest eigenpairs from ARPACK or, if there are few unknowns, from full matrices."""
    unknowns = problem.elimination_order
    stiffness, mass = problem.matrices(unknowns)
    if len(unknowns) <= max(DENSE_UNKNOWNS, wanted.at_most / DENSE_SHARE):
        values, of_unknowns = dense_eigenpairs(stiffness, mass, wanted.at_most)
    else:
        progress(0.0, "Factoring")
        factor = problem.factored(stiffness, mass)
        values, of_unknowns = arpack_eigenpairs(stiffness, mass, factor, wanted, section(progress, 0.3, 1.0))
    functions = np.zeros((problem.space.n_unknowns, len(values)))
    functions[unknowns] = of_unknowns
    return values, functions


def _block_eigenpairs(
    problem: EigenProblem, linear_start: Floats, linear_values: Floats, progress: Progress
) -> EigenPairs:
    """Return the lowest eigenpairs by block Lanczos iteration from linear functions on the same mesh."""
    n_pairs = len(linear_values)
    space, unknowns = problem.space, problem.elimination_order
    start = np.zeros((space.n_unknowns, linear_start.shape[1]))
    start[space.elements] = space.element.barycentric @ linear_start[space.mesh.triangles]
    stiffness, mass = problem.matrices(unknowns)
    progress(0.05, "Factoring")
    factor = problem.factored(stiffness, mass)
    pencil = Pencil(stiffness, mass, SHIFT, factor.solve)
    functions = np.zeros((space.n_unknowns, n_pairs))
    progress = section(progress, 0.4, 1.0)
    try:
        values, functions[unknowns] = smallest_eigenpairs(pencil, start[unknowns], n_pairs, TOLERANCE, progress)
        is_complete = bool(np.all(values <= linear_values + ROUNDING * linear_values[-1]))
    except (SpectrumError, np.linalg.LinAlgError):
        is_complete = False
    if not is_complete:
        values, functions[unknowns] = arpack_eigenpairs(stiffness, mass, factor, WantedPairs(n_pairs), progress)
    return values, functions
