"""Output: the part of each vertex, as most of its faces have it."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..mesh_data.mesh_arrays import (
    OwnAttribute,
    n_corners_of_polygon,
    remove_own_attributes,
    vertex_of_corner,
    write_attribute,
)
from ..mesh_state.stored_analysis import places_of_vertices
from .division import Division
from .output import Output

PART_VERTEX = OwnAttribute("part_vertex", "INT", "POINT")


def write(mesh: bpy.types.Mesh, division: Division) -> None:
    """Write the label of each vertex."""
    write_attribute(mesh, PART_VERTEX, labels_of_vertices(mesh, division.labels))


def remove(mesh: bpy.types.Mesh) -> None:
    """Take the output back."""
    remove_own_attributes(mesh, [PART_VERTEX.name])


def labels_of_vertices(mesh: bpy.types.Mesh, labels: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the (V,) int32 labels of the vertices for those of the faces; equal ones at one place along a seam."""
    label_of_corner, places = np.repeat(labels, n_corners_of_polygon(mesh)), places_of_vertices(mesh)
    if places is None:
        return majority_label(label_of_corner, vertex_of_corner(mesh), len(mesh.vertices))
    return majority_label(label_of_corner, places[vertex_of_corner(mesh)], len(mesh.vertices))[places]


def majority_label(
    label_of_corner: NDArray[np.int32], vertex_of_corner: NDArray[np.int32], n_vertices: int
) -> NDArray[np.int32]:
    """Return the (V,) int32 label that most corners at a vertex have, the smallest among equals; 0 without faces."""
    label = np.zeros(n_vertices, dtype=np.int32)
    label[vertex_of_corner] = label_of_corner
    # Only where labels meet is there anything to count.
    meets_others = np.zeros(n_vertices, dtype=bool)
    meets_others[vertex_of_corner[label_of_corner != label[vertex_of_corner]]] = True
    counted = meets_others[vertex_of_corner]
    vertices, row = np.unique(vertex_of_corner[counted], return_inverse=True)
    kinds, column = np.unique(label_of_corner[counted], return_inverse=True)
    votes = np.bincount(row * len(kinds) + column, minlength=len(vertices) * len(kinds))
    if len(vertices):
        label[vertices] = kinds[votes.reshape(len(vertices), len(kinds)).argmax(axis=1)]
    return label


OUTPUT = Output(
    "VERTEX_ATTRIBUTE",
    "Vertex Attribute",
    'Attribute "part_vertex": the part of most faces around',
    (PART_VERTEX,),
    write,
    remove,
    is_default=True,
)
