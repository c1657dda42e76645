"""Operator: write the eigenfunctions of a mesh as attributes of its vertices."""

from collections.abc import Callable
from functools import partial

import bpy

from ...tasks.vertex_functions import VertexFunctions, functions_on_vertices
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.typed_properties import IntProperty, TypedProperties
from ..jobs import background
from ..jobs.background import BackgroundOperator
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data import mesh_arrays
from ..mesh_data.mesh_arrays import OwnAttribute
from ..messages.sentences import Messages
from ..messages.user_errors import can_use_active_mesh

PREFIX = "eigenfunction_"


class EIGENPARTS_OT_write_eigenfunctions(BackgroundOperator, TypedProperties, bpy.types.Operator):
    """Write the smoothest eigenfunctions of the active mesh as vertex attributes"""

    bl_idname = "eigenparts.write_eigenfunctions"
    bl_label = "Write Eigenfunctions"
    bl_options = {"UNDO"}

    n_functions: int = IntProperty(
        name="Number",
        description="How many functions are written, from the smoothest on",
        default=6,
        min=1,
        soft_max=30,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return background.can_start_job(cls) and can_use_active_mesh(cls, context)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., VertexFunctions], MeshHandle]:
        mesh = mesh_of(context.object)
        mesh_arrays.refuse_foreign(mesh, _attributes_there(mesh, self.n_functions))
        shape = mesh_arrays.read_object(context, present(context.object), use_modifiers=False)
        solve = partial(functions_on_vertices, shape, self.n_functions)
        return solve, MeshHandle.of(present(context.object))

    def finish(self, context: bpy.types.Context, handle: MeshHandle, result: VertexFunctions) -> Outcome:
        mesh = handle.find_mesh()
        old = [name for name in mesh_arrays.own_names(mesh) if name.startswith(PREFIX)]
        mesh_arrays.remove_own_attributes(mesh, old)
        for own, function in zip(_attributes(self.n_functions), result.values.T, strict=True):
            mesh_arrays.write_attribute(mesh, own, function)
        mesh.update()
        Messages(warnings=result.warnings).report(self)
        return {"FINISHED"}


def _attributes(n_functions: int) -> tuple[OwnAttribute, ...]:
    return tuple(_attribute(number) for number in range(1, n_functions + 1))


def _attribute(number: int) -> OwnAttribute:
    return OwnAttribute(f"{PREFIX}{number}", "FLOAT", "POINT")


def _attributes_there(mesh: bpy.types.Mesh, n_functions: int) -> tuple[OwnAttribute, ...]:
    """Return those of the first attributes of functions whose names are taken: nobody can say how many there may be."""
    names = (name for name in mesh.attributes.keys() if name.removeprefix(PREFIX).isdecimal())  # noqa: SIM118
    return tuple(_attribute(number) for name in names if (number := int(name.removeprefix(PREFIX))) <= n_functions)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_write_eigenfunctions,))
