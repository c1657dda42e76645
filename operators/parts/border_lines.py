"""The borders of the parts that an object shows, as edges of its faces, for drawing."""

from hashlib import blake2b

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender.known_values import mesh_of
from ..mesh_data.attribute_values import read_attribute
from ..mesh_data.mesh_arrays import n_corners_of_polygon, read_edges
from ..mesh_state.state import is_analyzed
from ..outputs.division import PART

# By object: a digest of what the lines were made from, and the lines. Redrawing must not cost more than reading.
_made: dict[int, tuple[bytes, NDArray[np.float32]]] = {}


def border_lines(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> NDArray[np.float32]:
    """Return the (2n, 3) float32 ends of the edges between faces of different parts, in the space of the object.

    They are those of the object as its modifiers leave it. In edit mode there are none.
    """
    nothing = np.empty((0, 3), dtype=np.float32)
    if obj.type != "MESH" or mesh_of(obj).is_editmode or not is_analyzed(mesh_of(obj)):
        return nothing
    mesh = mesh_of(obj.evaluated_get(depsgraph))
    if not _has_parts(mesh):
        return nothing
    positions = read_attribute(mesh.attributes["position"])
    labels = read_attribute(mesh.attributes[PART.name]).ravel()
    digest = blake2b(positions.data, digest_size=16, key=blake2b(labels.data, digest_size=16).digest()).digest()
    if _made.get(obj.session_uid, (b"",))[0] != digest:
        _made[obj.session_uid] = digest, positions[_ends_of_borders(mesh, labels)]
    return _made[obj.session_uid][1]


def forget() -> None:
    """Drop all lines that were made."""
    _made.clear()


def _has_parts(mesh: bpy.types.Mesh) -> bool:
    part = mesh.attributes.get(PART.name)
    return part is not None and PART.is_kind_of(part)


def _ends_of_borders(mesh: bpy.types.Mesh, labels: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return the (2n,) vertices of the edges whose faces have more than one label."""
    edge_of_corner = read_attribute(mesh.attributes[".corner_edge"]).ravel()
    label_of_corner = np.repeat(labels, n_corners_of_polygon(mesh))
    # Of an edge's labels any will do: where one is different, there is a border.
    label_of_edge = np.zeros(len(mesh.edges), dtype=np.int32)
    label_of_edge[edge_of_corner] = label_of_corner
    is_border = np.zeros(len(mesh.edges), dtype=bool)
    is_border[edge_of_corner[label_of_corner != label_of_edge[edge_of_corner]]] = True
    return read_edges(mesh)[is_border].ravel()
