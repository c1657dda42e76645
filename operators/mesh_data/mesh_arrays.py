"""Copy data between Blender meshes and the engine: the one bridge.

Attributes we write are marked in a property of the mesh, so that nothing of the user's is ever overwritten or removed.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import blake2b
from typing import TypeVar

import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.attribute_types import AttributeType, Domain, Values
from ...tasks.mesh_shape import NO_STRETCH, MeshArrays, Stretch
from ...tasks.refusals import Refusal
from ..blender.known_values import elements_of, mesh_of
from ..messages.user_errors import IN_EDIT_MODE
from .world_shape import stretch_of

Number = TypeVar("Number", np.int32, np.float32)

# Names of the attributes that are ours, one a line.
OWN_ATTRIBUTES = "eigenparts_attributes"
# Names that ours may have: nothing else is ever taken for ours, whatever the list says.
OWN_NAME = re.compile(r"\.?eigenparts_\w+|eigenfunction_\d+|part|part_vertex|part_color|\.sculpt_face_set")


@dataclass(frozen=True)
class OwnAttribute:
    """An attribute of ours: its name, what it holds and where, and the property its values are in."""

    name: str
    data_type: AttributeType
    domain: Domain
    property_name: str = "value"

    def is_kind_of(self, attribute: bpy.types.Attribute) -> bool:
        """Whether an attribute has this type and domain."""
        return (attribute.data_type, attribute.domain) == (self.data_type, self.domain)

    def is_on(self, mesh: bpy.types.Mesh) -> bool:
        """Whether a mesh has an attribute of this name, type and domain."""
        attribute = mesh.attributes.get(self.name)
        return attribute is not None and self.is_kind_of(attribute)


def read_mesh(mesh: bpy.types.Mesh, stretch: Stretch = NO_STRETCH) -> MeshArrays:
    """Return the positions and the triangles of a mesh that is not in edit mode, stretched as in the world."""
    triangles = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    return MeshArrays(
        stretch.of(read_positions(mesh).astype(np.float64)),
        stretch.turned(triangles.reshape(-1, 3).astype(np.int64)),
        polygon_of_triangle(mesh).astype(np.int64),
        read_edges(mesh),
        stretch,
    )


def read_positions(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the (V, 3) places of the vertices of a mesh that is not in edit mode."""
    positions = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    if len(positions):
        elements_of(mesh.attributes["position"]).foreach_get("vector", positions)
    return positions.reshape(-1, 3)


def read_edges(mesh: bpy.types.Mesh) -> NDArray[np.int64]:
    """Return the (E, 2) vertices of each edge."""
    edges = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.edges.foreach_get("vertices", edges)
    return edges.reshape(-1, 2).astype(np.int64)


def read_evaluated_mesh(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> MeshArrays:
    """Return the shape as modifiers leave it; they may move it, but its faces must stay the same."""
    evaluated = mesh_of(obj.evaluated_get(depsgraph))
    if _faces_digest(evaluated) != _faces_digest(mesh_of(obj)):
        raise Refusal("The modifiers change the faces of the mesh; apply them first or analyze it without modifiers.")
    return read_mesh(evaluated, stretch_of(obj))


def read_object(context: bpy.types.Context, obj: bpy.types.Object, use_modifiers: bool) -> MeshArrays:
    """Return the shape of an object in the world, posed by its modifiers if that is wanted."""
    if use_modifiers:
        return read_evaluated_mesh(obj, context.evaluated_depsgraph_get())
    return read_mesh(mesh_of(obj), stretch_of(obj))


def read_vertex_floats(mesh: bpy.types.Mesh, name: str) -> NDArray[np.float64]:
    """Return the (V,) values of a float attribute of the vertices."""
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != ("FLOAT", "POINT"):
        raise Refusal(f'The mesh has no attribute "{name}" with one decimal number for each vertex.')
    elements = elements_of(attribute)
    values = np.empty(len(elements), dtype=np.float32)
    elements.foreach_get("value", values)
    return values.astype(np.float64)


def face_areas(mesh: bpy.types.Mesh, stretch: Stretch) -> NDArray[np.float64]:
    """Return the (F,) areas of the faces as they are stretched in the world."""
    areas, normals = np.empty(len(mesh.polygons), np.float32), np.empty(3 * len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("area", areas)
    mesh.polygons.foreach_get("normal", normals)
    return stretch.areas(areas.astype(np.float64), normals.reshape(-1, 3).astype(np.float64))


def polygon_of_triangle(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the (T,) polygon of each triangle."""
    polygons = np.empty(len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangle_polygons.foreach_get("value", polygons)
    return polygons


def n_corners_of_polygon(mesh: bpy.types.Mesh) -> NDArray[np.int64]:
    """Return the (F,) number of corners of each polygon."""
    # A polygon of n corners has n - 2 triangles, and they are read far faster than the polygons.
    return np.bincount(polygon_of_triangle(mesh), minlength=len(mesh.polygons)) + 2


def vertex_of_corner(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the (C,) vertex at each corner of each polygon."""
    vertices = np.empty(len(mesh.loops), dtype=np.int32)
    if len(vertices):
        elements_of(mesh.attributes[".corner_vert"]).foreach_get("value", vertices)
    return vertices


def fingerprint(mesh: bpy.types.Mesh) -> str:
    """Return a text that changes whenever a vertex or a face of the mesh does; not to be had in edit mode."""
    if mesh.is_editmode:
        raise Refusal(IN_EDIT_MODE)
    digest = blake2b(_faces_digest(mesh), digest_size=16)
    digest.update(read_positions(mesh).data)
    return digest.hexdigest()


def refuse_foreign(mesh: bpy.types.Mesh, attributes: tuple[OwnAttribute, ...]) -> None:
    """Raise a Refusal if an attribute of the user's stands where one of ours belongs."""
    for own in attributes:
        present = mesh.attributes.get(own.name)
        if present is not None and not (own.name in own_names(mesh) and own.is_kind_of(present)):
            raise Refusal(f'The mesh has an attribute "{own.name}" that is not from Eigenparts; rename or delete it.')


def write_attribute(mesh: bpy.types.Mesh, own: OwnAttribute, values: Values) -> None:
    """Store values in an attribute of ours, new or already there.

    Parameters
    ----------
    values : (n,) or (n, components)
        int32 or float32, as Blender keeps them; anything else is slow.
    """
    refuse_foreign(mesh, (own,))
    if own.name not in mesh.attributes:
        mesh.attributes.new(own.name, type=own.data_type, domain=own.domain)
        mark_own(mesh, [own.name])
    elements_of(mesh.attributes[own.name]).foreach_set(own.property_name, np.ascontiguousarray(values).ravel())


def write_attributes(mesh: bpy.types.Mesh, values: Mapping[OwnAttribute, Values | None]) -> None:
    """Store values in attributes of ours, as ``write_attribute`` does, and remove those that have None."""
    remove_own_attributes(mesh, [own.name for own, column in values.items() if column is None])
    for own, column in values.items():
        if column is not None:
            write_attribute(mesh, own, column)


def read_own_integers(mesh: bpy.types.Mesh, own: OwnAttribute) -> NDArray[np.int32]:
    """Return the (n,) int32 values of an attribute of ours."""
    return _read_own(mesh, own, np.int32, 1)


def read_own_floats(mesh: bpy.types.Mesh, own: OwnAttribute, n_components: int = 1) -> NDArray[np.float32]:
    """Return the (n * n_components,) float32 values of an attribute of ours."""
    return _read_own(mesh, own, np.float32, n_components)


def _read_own(mesh: bpy.types.Mesh, own: OwnAttribute, dtype: type[Number], n_components: int) -> NDArray[Number]:
    attribute = mesh.attributes.get(own.name)
    if attribute is None or not own.is_kind_of(attribute):
        raise Refusal(f'The attribute "{own.name}" of the analysis is gone; analyze the mesh again.')
    elements = elements_of(attribute)
    values = np.empty(n_components * len(elements), dtype=dtype)
    elements.foreach_get(own.property_name, values)
    return values


def remove_own_attributes(mesh: bpy.types.Mesh, names: list[str]) -> None:
    """Remove those of the named attributes that are ours."""
    owned = own_names(mesh)
    for name in set(names) & set(owned):
        if (attribute := mesh.attributes.get(name)) is not None:
            mesh.attributes.remove(attribute)
    _set_own_names(mesh, [name for name in owned if name not in names])


def own_names(mesh: bpy.types.Mesh) -> list[str]:
    """Return the names of the attributes that are marked as ours."""
    marked = mesh.get(OWN_ATTRIBUTES, "")
    return [name for name in marked.splitlines() if OWN_NAME.fullmatch(name)] if isinstance(marked, str) else []


def mark_own(mesh: bpy.types.Mesh, names: list[str]) -> None:
    """Mark attributes as ours."""
    _set_own_names(mesh, [*own_names(mesh), *names])


def mark_lost(mesh: bpy.types.Mesh, attributes: tuple[OwnAttribute, ...]) -> None:
    """Mark those of some attributes as ours that a mesh has, of their type and domain, but that are not marked."""
    marked = own_names(mesh)
    lost = [own.name for own in attributes if own.name not in marked and own.is_on(mesh)]
    if lost:
        mark_own(mesh, lost)


def _set_own_names(mesh: bpy.types.Mesh, names: list[str]) -> None:
    if names:
        mesh[OWN_ATTRIBUTES] = "\n".join(dict.fromkeys(names))
    elif mesh.get(OWN_ATTRIBUTES) is not None:
        del mesh[OWN_ATTRIBUTES]


def _faces_digest(mesh: bpy.types.Mesh) -> bytes:
    digest = blake2b(vertex_of_corner(mesh).data, digest_size=16)
    digest.update(polygon_of_triangle(mesh).data)
    return digest.digest()
