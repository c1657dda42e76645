"""The borders of the parts that an object shows, as edges of its faces, for drawing."""

from hashlib import blake2b

import bpy
import numpy as np

from ..mesh_data.mesh_arrays import n_corners_of_polygon, read_edges
from ..mesh_state.state import is_analyzed
from ..outputs.division import PART

# By object: a digest of what the lines were made from, and the lines. Redrawing must not cost more than reading.
_made: dict[int, tuple[bytes, np.ndarray]] = {}


def border_lines(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    """Return the (2n, 3) float32 ends of the edges between faces of different parts, in the space of the object.

    They are those of the object as its modifiers leave it. In edit mode there are none.
    """
    mesh = obj.evaluated_get(depsgraph).data
    if obj.type != "MESH" or obj.data.is_editmode or not is_analyzed(obj.data) or not _has_parts(mesh):
        return np.empty((0, 3), dtype=np.float32)
    positions, labels = (
        _values(mesh, "position", "vector", 3, np.float32),
        _values(mesh, PART.name, "value", 1, np.int32),
    )
    digest = blake2b(positions, digest_size=16, key=blake2b(labels, digest_size=16).digest()).digest()
    if _made.get(obj.session_uid, (b"",))[0] != digest:
        _made[obj.session_uid] = digest, positions.reshape(-1, 3)[_ends_of_borders(mesh, labels)]
    return _made[obj.session_uid][1]


def forget() -> None:
    """Drop all lines that were made."""
    _made.clear()


def _has_parts(mesh: bpy.types.Mesh) -> bool:
    part = mesh.attributes.get(PART.name)
    return part is not None and PART.is_kind_of(part)


def _ends_of_borders(mesh: bpy.types.Mesh, labels: np.ndarray) -> np.ndarray:
    """Return the (2n,) vertices of the edges whose faces have more than one label."""
    edge_of_corner = _values(mesh, ".corner_edge", "value", 1, np.int32)
    label_of_corner = np.repeat(labels, n_corners_of_polygon(mesh))
    # Of an edge's labels any will do: where one is different, there is a border.
    label_of_edge = np.zeros(len(mesh.edges), dtype=np.int32)
    label_of_edge[edge_of_corner] = label_of_corner
    is_border = np.zeros(len(mesh.edges), dtype=bool)
    is_border[edge_of_corner[label_of_corner != label_of_edge[edge_of_corner]]] = True
    return read_edges(mesh)[is_border].ravel()


def _values(mesh: bpy.types.Mesh, attribute: str, name: str, n_components: int, dtype: type) -> np.ndarray:
    data = mesh.attributes[attribute].data
    values = np.empty(n_components * len(data), dtype=dtype)
    data.foreach_get(name, values)
    return values
