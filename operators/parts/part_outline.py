"""The outline of the part that is active in the list, as edges of faces, for drawing."""

import bpy
import numpy as np

from ..mesh_data.mesh_arrays import n_corners_of_polygon, read_edges
from ..mesh_state.state import is_analyzed
from ..outputs.division import PART


def outline(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    """Return the (2n, 3) float32 ends of the edges around the active part of an object, in the space of the object.

    They are those of the object as its modifiers leave it. In edit mode, where the faces show as selected, there are
    none.
    """
    nothing = np.empty((0, 3), dtype=np.float32)
    if obj.type != "MESH" or obj.data.is_editmode or not is_analyzed(obj.data) or obj.data.eigenparts.active_row < 0:
        return nothing
    mesh = obj.evaluated_get(depsgraph).data
    part = mesh.attributes.get(PART.name)
    if part is None or not PART.is_kind_of(part):
        return nothing
    labels = _values(mesh, PART.name, "value", 1, np.int32)
    positions = _values(mesh, "position", "vector", 3, np.float32).reshape(-1, 3)
    return positions[_edges_around(mesh, labels == obj.data.eigenparts.active_part)]


def _edges_around(mesh: bpy.types.Mesh, is_inside: np.ndarray) -> np.ndarray:
    """Return the (2n,) vertices of the edges that have faces inside and others, or none, outside."""
    edge_of_corner = _values(mesh, ".corner_edge", "value", 1, np.int32)
    inside = np.repeat(is_inside, n_corners_of_polygon(mesh))
    n_inside, n_all = (
        np.bincount(edges, minlength=len(mesh.edges)) for edges in (edge_of_corner[inside], edge_of_corner)
    )
    return read_edges(mesh)[(n_inside > 0) & ((n_inside < n_all) | (n_all == 1))].ravel()


def _values(mesh: bpy.types.Mesh, attribute: str, name: str, n_components: int, dtype: type) -> np.ndarray:
    data = mesh.attributes[attribute].data
    values = np.empty(n_components * len(data), dtype=dtype)
    data.foreach_get(name, values)
    return values
