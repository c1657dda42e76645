"""From what the user asks for to a field: how many functions, of which order, and the field itself."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..errors import FieldError
from ..fem.eigenbasis import Eigenbasis, solve_on_surface
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
    """Return the order that is asked for, or the one that a surface can afford."""
    if not isinstance(order, str):
        require_order(surface.mesh, order)
        return OrderChoice(order)
    if order != "auto":
        raise FieldError(f'The order is 1, 2, 3 or "auto", not "{order}".')
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
    chosen = resolved_order(order, surface)
    # Whoever asks for a number of functions gets them; otherwise those without weight are not computed.
    largest_ratio = LARGEST_RATIO if n_functions is None else np.inf
    n_functions = n_functions or min(DIFFUSION_FUNCTIONS, n_available(surface, boundary))
    basis = solve_on_surface(
        surface, n_functions, order=chosen.order, boundary=boundary, largest_ratio=largest_ratio, progress=progress
    )
    return ChosenField(diffusion_field(basis), basis, _warnings_of(chosen))


def _eigenfunction(
    surface: Surface, number: int, n_functions: int | None, order: int | str, boundary: str, progress: Progress
) -> ChosenField:
    chosen = resolved_order(order, surface)
    n_functions = max(n_functions or min(DEFAULT_FUNCTIONS, n_available(surface, boundary)), number)
    basis = solve_on_surface(surface, n_functions, order=chosen.order, boundary=boundary, progress=progress)
    return ChosenField(eigenfunction_field(basis, number), basis, _warnings_of(chosen))


def _warnings_of(chosen: OrderChoice) -> tuple[str, ...]:
    return () if chosen.warning is None else (chosen.warning,)
