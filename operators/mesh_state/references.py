"""Objects that are registered, and those they are registered to."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..blender.known_values import mesh_of, present
from .state import MeshState, read


def registered_objects(context: bpy.types.Context) -> Iterator[tuple[bpy.types.Object, MeshState]]:
    """Yield the objects of the view that show the parts of another, with what their meshes remember."""
    for obj in present(context.view_layer).objects:
        state = read(mesh_of(obj)) if obj.type == "MESH" else None
        if state is not None and state.match is not None:
            yield obj, state


def reference_of(state: MeshState) -> bpy.types.Object | None:
    """Return the mesh object that a mesh is registered to, if it is there."""
    match = state.match
    reference = bpy.data.objects.get(match.reference) if match is not None else None
    return reference if reference is not None and reference.type == "MESH" else None


def state_of_reference(state: MeshState) -> MeshState | None:
    """Return what the mesh remembers that a mesh is registered to; None if it is not, or the other is not there."""
    reference = reference_of(state)
    return None if reference is None else read(mesh_of(reference))
