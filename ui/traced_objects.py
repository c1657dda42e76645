"""The objects of traced complexes in the scene, by their role."""

from collections.abc import Container, Iterator

import bpy
from mathutils import Vector

from ..operators.blender.known_values import numbers_of, present
from ..operators.mesh_state.palette import COMPLEX_COLOURS, COMPLEX_ROLE


def traced_objects(context: bpy.types.Context) -> Iterator[bpy.types.Object]:
    """Yield the objects of traced complexes that can be seen."""
    return (obj for obj in objects_of_roles(context, COMPLEX_COLOURS) if obj.visible_get())


def objects_of_roles(context: bpy.types.Context, roles: Container[str]) -> Iterator[bpy.types.Object]:
    """Yield the objects of traced complexes that have one of some roles, the hidden ones too."""
    return (obj for obj in present(context.view_layer).objects if obj.get(COMPLEX_ROLE) in roles)


def critical_points_of(obj: bpy.types.Object) -> list[Vector]:
    """Return the critical points of an object in the world; the object keeps them for this."""
    flat = list(numbers_of(obj, "places"))
    return [obj.matrix_world @ Vector(flat[k : k + 3]) for k in range(0, len(flat), 3)]
