"""From what the user asks for to a field: how many functions, of which order, and the field itself."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..errors import FieldError
from ..fem.eigenbasis import Eigenbasis, solve_on_surface
from ..fem.elements_by_need import solve_by_need
from ..fem.order_choice import OrderChoice, choose_order, require_order
from ..progress import Progress
from ..surface.cleaning import Surface
from .scalar_field import (
    DIFFUSION,
    DIFFUSION_FUNCTIONS,
    LARGEST_RATIO,
    ScalarField,
    diffusion_field,
    eigenfunction_field,
    user_field,
)

# Functions computed for the first eigenfunctions when nobody asks for a number.
DEFAULT_FUNCTIONS = 12


@dataclass(frozen=True, eq=False)
class ChosenField:
    """A field, the functions it is made of unless it is the user's own, and sentences for the user."""

    field: ScalarField
    basis: Eigenbasis | None
    warnings: tuple[str, ...] = ()


def choose_field(
    surface: Surface,
    choice: str | int | ArrayLike,
    n_functions: int | None,
    order: int | str,
    boundary: str,
    progress: Progress,
) -> ChosenField:
    """Compute the field that `analyze` is asked for; see there."""
    if isinstance(choice, str):
        return _diffusion(surface, choice, n_functions, order, boundary, progress)
    if isinstance(choice, int | np.integer):
        return _eigenfunction(surface, int(choice), n_functions, order, boundary, progress)
    return ChosenField(user_field(surface, choice), None)


def resolved_order(order: int | str, surface: Surface) -> OrderChoice:
    """Return the order that is asked for, or the best that a surface can afford."""
    if not isinstance(order, str):
        require_order(surface.mesh, order)
        return OrderChoice(order)
    _check_order(order)
    return choose_order(surface.mesh)


def n_available(surface: Surface, boundary: str) -> int:
    """Return a number of functions that elements of every order carry, one at least."""
    edges = surface.mesh.edges
    n_vertices = len(surface.mesh.used)
    n_held = len(np.unique(edges.vertices[edges.n_triangles == 1])) if boundary == "dirichlet" else 1
    return max(n_vertices - n_held, 1)


def _diffusion(
    surface: Surface, name: str, n_functions: int | None, order: int | str, boundary: str, progress: Progress
) -> ChosenField:
    if name != DIFFUSION:
        raise FieldError(f'The field "{name}" does not exist; use "diffusion", a number or values of your own.')
    # Whoever asks for a number of functions gets them; otherwise those without weight are not computed.
    largest_ratio = LARGEST_RATIO if n_functions is None else np.inf
    n_functions = n_functions or min(DIFFUSION_FUNCTIONS, n_available(surface, boundary))
    basis, warnings = _solve(surface, n_functions, order, boundary, largest_ratio, progress)
    return ChosenField(diffusion_field(basis), basis, warnings)


def _eigenfunction(
    surface: Surface, number: int, n_functions: int | None, order: int | str, boundary: str, progress: Progress
) -> ChosenField:
    n_functions = max(n_functions or min(DEFAULT_FUNCTIONS, n_available(surface, boundary)), number)
    basis, warnings = _solve(surface, n_functions, order, boundary, np.inf, progress)
    return ChosenField(eigenfunction_field(basis, number), basis, warnings)


def _solve(
    surface: Surface, n_functions: int, order: int | str, boundary: str, largest_ratio: float, progress: Progress
) -> tuple[Eigenbasis, tuple[str, ...]]:
    """Return eigenfunctions of the order that is asked for or needed, and sentences for the user."""
    if isinstance(order, str):
        _check_order(order)
        basis, warning = solve_by_need(
            surface, n_functions, boundary=boundary, largest_ratio=largest_ratio, progress=progress
        )
        return basis, () if warning is None else (warning,)
    require_order(surface.mesh, order)
    basis = solve_on_surface(
        surface, n_functions, order=order, boundary=boundary, largest_ratio=largest_ratio, progress=progress
    )
    return basis, ()


def _check_order(order: str) -> None:
    if order != "auto":
        raise FieldError(f'The order is 1, 2, 3 or "auto", not "{order}".')
