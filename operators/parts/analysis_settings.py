"""Settings of an analysis as values, whether they come from a panel, a script, a file or the command line."""

from __future__ import annotations

from dataclasses import dataclass, fields

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_analysis import AnalysisInput
from ...tasks.recent_analyses import EngineOptions
from ..blender.known_values import mesh_of
from ..mesh_data import mesh_arrays
from ..mesh_state.palette import PARTS
from .choice_items import ATTRIBUTE, EIGENFUNCTION, identifier, word


@dataclass(frozen=True)
class AnalysisSettings:
    """Settings of an analysis, named as the properties of the operators.

    Attributes
    ----------
    field : str
        One of ``FIELD_ITEMS``.
    eigenfunction : int
        Number of the eigenfunction, from 1.
    attribute : str
        Name of the attribute with the values of the field.
    order, boundary, shells, borders : str
        Each one of ``ORDER_ITEMS``, ``BOUNDARY_ITEMS``, ``SHELL_ITEMS`` and ``BORDER_ITEMS``.
    use_modifiers : bool
        Whether the mesh is read as its modifiers leave it.
    """

    field: str = identifier(compute.FIELDS[0])
    eigenfunction: int = 1
    attribute: str = ""
    order: str = identifier(compute.ORDERS[0])
    boundary: str = identifier(compute.BOUNDARIES[0])
    shells: str = identifier(compute.SHELLS[0])
    borders: str = identifier(compute.BORDERS[0])
    use_modifiers: bool = False


SETTINGS = tuple(field.name for field in fields(AnalysisSettings))


def read_input(context: bpy.types.Context, obj: bpy.types.Object, settings: AnalysisSettings) -> AnalysisInput:
    """Return the mesh of an object, posed if that is wanted, and the keyword arguments of the engine."""
    options = engine_options(mesh_of(obj), settings)
    arrays = mesh_arrays.read_object(context, obj, settings.use_modifiers)
    return AnalysisInput(obj.name, arrays, options, n_colours=len(PARTS))


def engine_options(mesh: bpy.types.Mesh, settings: AnalysisSettings) -> EngineOptions:
    """Return the keyword arguments of the engine for the settings of the user."""
    return {
        "field": _field(mesh, settings),
        "order": word(compute.ORDERS, settings.order),
        "boundary": word(compute.BOUNDARIES, settings.boundary),
        "shells": word(compute.SHELLS, settings.shells),
        "borders": word(compute.BORDERS, settings.borders),
    }


def _field(mesh: bpy.types.Mesh, settings: AnalysisSettings) -> str | int | NDArray[np.float64]:
    if settings.field == EIGENFUNCTION:
        return settings.eigenfunction
    if settings.field == ATTRIBUTE:
        return mesh_arrays.read_vertex_floats(mesh, settings.attribute)
    return word(compute.FIELDS, settings.field)
