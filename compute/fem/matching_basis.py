"""The eigenfunctions that shapes are matched by: many, free, and accurate on any mesh."""

from dataclasses import replace

import numpy as np

from ..progress import Progress
from ..surface.cleaning import Surface
from .eigenbasis import Eigenbasis, solve_on_surface
from .order_choice import n_unknowns

# Functions for matching and dense maps, and the least number of unknowns that carry them accurately: elements of a
# higher order are used where linear ones have fewer.
MATCHING_FUNCTIONS = 100
MATCHING_UNKNOWNS = 3000


class MatchingBasis:
    """The eigenfunctions that a surface is matched by: solved for when they are first asked for, and kept."""

    def __init__(self, surface: Surface, shown: Eigenbasis | None) -> None:
        self._surface = surface
        self._shown = shown
        self._solved: Eigenbasis | None = None

    def solve(self, progress: Progress) -> Eigenbasis:
        """Return the eigenfunctions; ``progress`` is called if they have to be computed."""
        if self._solved is None:
            self._solved = solve_for_matching(self._surface, self._shown, progress)
        return self._solved


def solve_for_matching(surface: Surface, shown: Eigenbasis | None, progress: Progress) -> Eigenbasis:
    """Return free eigenfunctions of a surface, with the signs of those that the user sees, if there are any."""
    order = matching_order(surface)
    n_functions = min(MATCHING_FUNCTIONS, n_unknowns(surface.mesh, order) - 1)
    basis = solve_on_surface(surface, n_functions, order=order, progress=progress)
    return basis if shown is None else _with_signs_of(shown, basis, len(surface.vertex_of_input))


def matching_order(surface: Surface) -> int:
    """Return the lowest order of elements that has enough unknowns for matching."""
    return next((order for order in (1, 2) if n_unknowns(surface.mesh, order) >= MATCHING_UNKNOWNS), 3)


def _with_signs_of(shown: Eigenbasis, basis: Eigenbasis, n_vertices: int) -> Eigenbasis:
    """Return a basis whose functions point where those do that the user sees; elements of two orders may differ."""
    n_shared = min(len(shown.values), len(basis.values)) if shown.boundary == basis.boundary else 0
    functions = basis.functions.copy()
    agreement = (shown.functions[:n_vertices, :n_shared] * functions[:n_vertices, :n_shared]).sum(axis=0)
    functions[:, :n_shared] *= np.where(agreement < 0, -1.0, 1.0)
    return replace(basis, functions=functions)
