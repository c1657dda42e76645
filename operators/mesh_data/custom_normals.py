"""Custom normals while faces change: Blender stores them relative to the faces around, and they turn with these."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

import bpy
import numpy as np

from .attribute_values import read_attribute, store_values

# While faces change: the normals of the corners as vectors, which Blender interpolates along cut edges.
KEPT_NORMALS = "eigenparts_kept_normals"
# In newer versions normals may be stored as vectors, which need no help.
CUSTOM_NORMALS: Final = "custom_normal"
VECTORS: Final = "FLOAT_VECTOR"


@contextmanager
def normals_kept(mesh: bpy.types.Mesh) -> Iterator[None]:
    """Give the corners of a mesh with custom normals those back that they had before the block changed its faces."""
    if not _are_relative(mesh):
        yield
        return
    normals = np.empty(3 * len(mesh.loops), dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", normals)
    # Not kept in a variable, as adding an attribute may move the others in memory.
    mesh.attributes.new(KEPT_NORMALS, VECTORS, "CORNER")
    store_values(mesh.attributes[KEPT_NORMALS], normals)
    yield
    normals = read_attribute(mesh.attributes[KEPT_NORMALS])
    mesh.attributes.remove(mesh.attributes[KEPT_NORMALS])
    mesh.normals_split_custom_set(normals.tolist())


def _are_relative(mesh: bpy.types.Mesh) -> bool:
    attribute = mesh.attributes.get(CUSTOM_NORMALS)
    return mesh.has_custom_normals and (attribute is None or attribute.data_type != VECTORS)
