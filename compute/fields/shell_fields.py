"""A field for shells that are analyzed each by itself: on every shell its own, all with the range 1."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from ..errors import EngineError, MeshError
from ..fem.space import function_space
from ..progress import Progress, section
from ..surface.cleaning import Surface
from ..surface.mesh import Bools, Floats, Ints, TriangleMesh
from ..surface.ties import evened
from .field_choice import ChosenField, choose_field, resolved_order
from .scalar_field import Net, ScalarField, net_of_elements

# Shells of fewer triangles are one part, whatever their shape.
LEAST_TRIANGLES = 8


def choose_fields(
    surface: Surface,
    choice: str | int | ArrayLike,
    n_functions: int | None,
    order: int | str,
    boundary: str,
    progress: Progress,
) -> ChosenField:
    """Compute the field that `analyze` is asked for on every shell of a surface by itself.

    Each rises from 0 to 1, so that a feature of a shell is as persistent among those of all as it is among its own. A
    shell that has no field, or a flat one, has 0 and so no features.

    Raises
    ------
    EngineError
        If no shell has a field.
    """
    has_elements = isinstance(choice, str | int | np.integer)
    chosen = resolved_order(order, surface)
    net = _net(surface, chosen.order if has_elements else 1)
    values = np.zeros(len(net.positions))
    solve = partial(choose_field, choice=choice, n_functions=n_functions, order=chosen.order, boundary=boundary)
    fields, problems = [], []
    for corners, result in _solved(surface, net, solve, progress):
        if isinstance(result, EngineError):
            problems.append(result)
        else:
            values[corners] = _from_0_to_1(result.field)
            fields.append(result)
    if not fields:
        raise problems[0] if problems else MeshError("No loose part has enough faces to be divided by itself.")
    joint = replace(fields[0].field, values=evened(values), net=net, least_range=0.0)
    slow = (chosen.warning,) if has_elements and chosen.warning else ()
    return ChosenField(joint, None, (*slow, *_warnings_of(problems)))


def _solved(
    surface: Surface, net: Net, solve: Callable[..., ChosenField], progress: Progress
) -> Iterator[tuple[Ints, ChosenField | EngineError]]:
    """Yield the corners of the net on each shell that is large enough, and its field or what is wrong with it."""
    shell = surface.mesh.component_of_triangle
    n_shells = int(shell.max()) + 1
    corners = net.triangles.reshape(len(shell), -1, 3)
    for number in range(n_shells):
        is_inside = shell == number
        if np.count_nonzero(is_inside) < LEAST_TRIANGLES:
            continue
        step = section(progress, number / n_shells, (number + 1) / n_shells)
        yield corners[is_inside].reshape(-1, 3), _attempt(partial(solve, progress=step), surface, is_inside)


def _attempt(solve: Callable[[Surface], ChosenField], surface: Surface, is_inside: Bools) -> ChosenField | EngineError:
    """Return the field of a shell, or what is wrong with it: others may have one all the same."""
    try:
        return solve(_alone(surface, is_inside))
    except EngineError as error:
        return error


def _alone(surface: Surface, is_inside: Bools) -> Surface:
    """Return one shell to be solved on; its map back to the input is that of all."""
    mesh = TriangleMesh(surface.mesh.vertices, surface.mesh.triangles[is_inside])
    return replace(surface, mesh=mesh, input_triangle=surface.input_triangle[is_inside], is_apart=False)


def _net(surface: Surface, order: int) -> Net:
    """Return the net of all shells; its triangles stand in the order of theirs."""
    space = function_space(surface.mesh, order)
    return net_of_elements(space.nodes, space.elements, order, surface)


def _from_0_to_1(field: ScalarField) -> Floats:
    """Return the values at the corners of the net's triangles, (m, 3)."""
    values = field.values[field.net.triangles]
    if not field.value_range > field.least_range:
        return np.zeros_like(values)
    return (values - values.min()) / field.value_range


def _warnings_of(problems: list[EngineError]) -> tuple[str, ...]:
    if not problems:
        return ()
    return (f"{len(problems)} of the loose parts could not be divided by themselves: {problems[0]}",)
