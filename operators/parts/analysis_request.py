"""Base class of the operators that analyze the active mesh: when they can, what is read, and with which settings."""

from typing import Any

import bpy

from ... import compute
from ..jobs import background
from ..jobs.background import BackgroundOperator
from ..mesh_data import mesh_arrays
from ..messages.user_errors import can_use_active_mesh
from .analysis_options import AnalysisOptions
from .choice_items import ATTRIBUTE, EIGENFUNCTION, word


class AnalysisRequest(AnalysisOptions, BackgroundOperator):
    """Analyzes the active mesh in the background."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return background.can_start_job(cls) and can_use_active_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """From the window: what the call leaves open is taken from the panel."""
        for name in AnalysisOptions.__annotations__:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.scene.eigenparts, name))
        return super().invoke(context, event)

    def read(self, context: bpy.types.Context) -> tuple[mesh_arrays.MeshArrays, dict[str, Any]]:
        """Return the active mesh, posed if that is wanted, and the keyword arguments of the engine."""
        arrays = mesh_arrays.read_object(context, context.object, self.use_modifiers)
        options = analysis_options(
            context.object.data,
            self.field,
            self.eigenfunction,
            self.attribute,
            order=self.order,
            boundary=self.boundary,
            shells=self.shells,
        )
        return arrays, options


def analysis_options(
    mesh: bpy.types.Mesh, field: str, eigenfunction: int, attribute: str, *, order: str, boundary: str, shells: str
) -> dict[str, Any]:
    """Return the keyword arguments of the engine for the settings of the user."""
    return {
        "field": _field(mesh, field, eigenfunction, attribute),
        "order": word(compute.ORDERS, order),
        "boundary": word(compute.BOUNDARIES, boundary),
        "shells": word(compute.SHELLS, shells),
    }


def _field(mesh: bpy.types.Mesh, field: str, eigenfunction: int, attribute: str) -> Any:
    if field == EIGENFUNCTION:
        return eigenfunction
    return mesh_arrays.read_vertex_floats(mesh, attribute) if field == ATTRIBUTE else word(compute.FIELDS, field)
