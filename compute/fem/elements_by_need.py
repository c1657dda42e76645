"""Elements by need: linear ones where the error of their eigenvalues is small enough, otherwise the best affordable."""

import numpy as np

from ..errors import SpectrumError
from ..progress import Progress, section
from ..surface.cleaning import Surface
from .eigenbasis import Eigenbasis, basis_of_pairs, posed_problem, wanted_pairs
from .eigensolver import DENSE_SHARE, EigenPairs, EigenProblem, linear_eigenpairs, lowest_eigenpairs
from .linear_error import relative_excess
from .multilevel_eigenpairs import is_for_levels, multilevel_eigenpairs
from .order_choice import choose_order
from .shift_invert import WantedPairs

# Largest estimated error of a linear eigenvalue with which the parts are those of cubic elements on 99.5 % of the area
# (docs/spectrum.md, chosen on one half of the meshes there and judged on the other).
LARGEST_EXCESS = 0.004
# No mesh of fewer vertices was seen to reach it, apart from spheres and tori.
LEAST_VERTICES = 3000


def solve_by_need(
    surface: Surface, n_functions: int, *, boundary: str, largest_ratio: float, progress: Progress
) -> tuple[Eigenbasis, str | None]:
    """Return the smoothest eigenfunctions with the elements that a surface needs, or a sentence with others.

    Parameters
    ----------
    surface : Surface
        Clean.
    n_functions, boundary, largest_ratio, progress
        As for `compute.fem.eigenbasis.solve_on_surface`.

    Raises
    ------
    MeshError, SpectrumError
        As there, or if not even linear elements fit into the memory at hand.
    """
    progress(0.0, "Building the finite elements")
    best = choose_order(surface.mesh)
    wanted = wanted_pairs(n_functions, boundary, largest_ratio)
    start = None
    if len(surface.mesh.used) >= max(LEAST_VERTICES, wanted.at_most / DENSE_SHARE):
        linear = posed_problem(surface, n_functions, 1, boundary)
        start = linear_pairs(linear, wanted, section(progress, 0.0, 0.15))
        is_enough = _largest_excess(linear, wanted, start) <= LARGEST_EXCESS
        if is_enough or best.order == 1:
            return basis_of_pairs(surface, linear, wanted, start, progress), None if is_enough else best.warning
    problem = posed_problem(surface, n_functions, best.order, boundary)
    pairs = lowest_eigenpairs(problem, wanted, progress, start)
    return basis_of_pairs(surface, problem, wanted, pairs, progress), best.warning


def linear_pairs(linear: EigenProblem, wanted: WantedPairs, progress: Progress) -> EigenPairs:
    """Return the pairs of linear elements: by way of coarser levels where that is faster and converges."""
    if is_for_levels(linear, wanted):
        try:
            return multilevel_eigenpairs(linear, wanted, progress)
        except (SpectrumError, np.linalg.LinAlgError):
            pass  # What has no good levels is factored.
    return linear_eigenpairs(linear, wanted, progress)


def _largest_excess(linear: EigenProblem, wanted: WantedPairs, pairs: EigenPairs) -> float:
    """Return the largest estimated error of the eigenvalues that are wanted."""
    values, functions = pairs
    used = slice(wanted.n_constant, wanted.n_within(values))
    # A first value that is zero means a surface that falls apart, which is refused later.
    if not values[used].min(initial=np.inf) > 0:
        return np.inf
    return float(relative_excess(linear, values[used], functions[:, used]).max(initial=0.0))
