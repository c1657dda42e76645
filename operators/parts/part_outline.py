"""The outline of the part that is active in the list, as edges of faces, for drawing."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender.known_values import mesh_of
from ..blender.registered_settings import mesh_settings
from ..mesh_data.attribute_values import read_attribute
from ..mesh_data.mesh_arrays import n_corners_of_polygon, read_edges
from ..mesh_state.state import is_analyzed
from ..outputs.division import PART


def outline(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> NDArray[np.float32]:
    """Return the (2n, 3) float32 ends of the edges around the active part of an object, in the space of the object.

    They are those of the object as its modifiers leave it. In edit mode, where the faces show as selected, there are
    none.
    """
    nothing = np.empty((0, 3), dtype=np.float32)
    if (
        obj.type != "MESH"
        or mesh_of(obj).is_editmode
        or not is_analyzed(mesh_of(obj))
        or mesh_settings(mesh_of(obj)).active_row < 0
    ):
        return nothing
    mesh = mesh_of(obj.evaluated_get(depsgraph))
    part = mesh.attributes.get(PART.name)
    if part is None or not PART.is_kind_of(part):
        return nothing
    labels = read_attribute(mesh.attributes[PART.name]).ravel()
    positions = read_attribute(mesh.attributes["position"])
    return positions[_edges_around(mesh, labels == mesh_settings(mesh_of(obj)).active_part)]


def _edges_around(mesh: bpy.types.Mesh, is_inside: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the (2n,) vertices of the edges that have faces inside and others, or none, outside."""
    edge_of_corner = read_attribute(mesh.attributes[".corner_edge"]).ravel()
    inside = np.repeat(is_inside, n_corners_of_polygon(mesh))
    n_inside, n_all = (
        np.bincount(edges, minlength=len(mesh.edges)) for edges in (edge_of_corner[inside], edge_of_corner)
    )
    return read_edges(mesh)[(n_inside > 0) & ((n_inside < n_all) | (n_all == 1))].ravel()
