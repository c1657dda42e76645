"""The pairs of points that the user gives: a vertex of one object and the vertex of another that it belongs to.

The scene keeps them; the first has number 1, and each is told and drawn by its number.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ...tasks.match_options import GivenPoints
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of
from ..blender.registered_settings import PointPairRow, point_pairs

CHANGED = "Point {} was given before the vertices of {} changed; remove it and give it again."


@dataclass(frozen=True)
class PointEnd:
    """One of the two points of a pair: a vertex of an object.

    Attributes
    ----------
    obj : Object
    vertex : int
    n_vertices : int
        Of its mesh when the point was given.
    """

    obj: bpy.types.Object
    vertex: int
    n_vertices: int

    @property
    def is_there(self) -> bool:
        """Whether the mesh still has as many vertices, so that the number is likely to be the same one's."""
        return len(mesh_of(self.obj).vertices) == self.n_vertices > self.vertex >= 0


def shown_places(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> NDArray[np.float32]:
    """Return (V, 3) the places of the vertices of an object, in its space, as they are seen."""
    vertices = _shown_mesh(obj, depsgraph).vertices
    places = np.empty(3 * len(vertices), dtype=np.float32)
    vertices.foreach_get("co", places)
    return places.reshape(-1, 3)


def shown_place(end: PointEnd, depsgraph: bpy.types.Depsgraph) -> Vector:
    """Return the place of one point in the same way."""
    return _shown_mesh(end.obj, depsgraph).vertices[end.vertex].co


def _shown_mesh(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bpy.types.Mesh:
    """Return a mesh as modifiers leave it if these keep the number of vertices; as it is otherwise."""
    mesh, evaluated = mesh_of(obj), obj.evaluated_get(depsgraph).data
    if isinstance(evaluated, bpy.types.Mesh) and len(evaluated.vertices) == len(mesh.vertices):
        return evaluated
    return mesh


def ends_of(row: PointPairRow) -> tuple[PointEnd, ...]:
    """Return the two points of a pair; none if an object is gone."""
    given = ((row.source, row.source_vertex, row.n_source), (row.target, row.target_vertex, row.n_target))
    ends = tuple(PointEnd(obj, *numbers) for obj, *numbers in given if obj is not None and obj.type == "MESH")
    return ends if len(ends) == len(given) else ()


def points_between(
    context: bpy.types.Context, source: bpy.types.Object | None, target: bpy.types.Object
) -> GivenPoints:
    """Return the points of a source and a target, whichever of the two was clicked first.

    Raises
    ------
    Refusal
        If the vertices of one changed since.
    """
    found = {}
    for number, (first, second) in numbered_pairs(context):
        if (first.obj, second.obj) in ((source, target), (target, source)):
            for end in (first, second):
                if not end.is_there:
                    raise Refusal(CHANGED.format(number, end.obj.name))
            found[number] = (first.vertex, second.vertex) if first.obj == source else (second.vertex, first.vertex)
    return GivenPoints(tuple(found.values()), tuple(found))


def numbered_pairs(context: bpy.types.Context) -> Iterator[tuple[int, tuple[PointEnd, PointEnd]]]:
    """Yield the number and the two points of each pair whose objects are there."""
    for number, row in enumerate(point_pairs(context), start=1):
        if ends := ends_of(row):
            yield number, (ends[0], ends[1])
