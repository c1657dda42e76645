"""Write a segmentation to a mesh: the face map, its vertex version, and the colours."""

import bpy
import numpy as np

from . import engine, state
from .exchange import OwnAttribute, n_corners_of_polygon, refuse_foreign, vertex_of_corner, write_attribute
from .palette import colours_of_labels

PART = OwnAttribute("part", "INT", "FACE")
PART_VERTEX = OwnAttribute("part_vertex", "INT", "POINT")
# Decimal colours are copied as they are; byte colours are converted one by one, which is thirty times slower.
PART_COLOR = OwnAttribute("part_color", "FLOAT_COLOR", "CORNER", "color")
RESULTS = (PART, PART_VERTEX, PART_COLOR)

# The active colour attribute that the user had before ours.
PREVIOUS_COLOR = "eigenparts_previous_color"


def segment_mesh(mesh: bpy.types.Mesh, *, mode: str | None = None, **choice: float) -> "engine.BranchLabels":
    """Divide an analyzed mesh into parts and write them.

    Parameters
    ----------
    mode : "features" or "nested", optional
        The one that the mesh shows, if None.
    **choice
        One of ``level``, ``threshold`` and ``n_parts``, or none for the default level.

    Raises
    ------
    Refusal, EngineError
        If the mesh has no usable analysis or the level does not exist; nothing is changed then.
    """
    refuse_foreign(mesh, RESULTS)
    analysis = state.load(mesh)
    mode = mode or state.mode_of(mesh)
    labels = engine.label_branches(analysis.hierarchy, analysis.branches, mode=mode, **choice)
    write_labels(mesh, labels.of_faces(analysis.branches))
    state.remember_segmentation(mesh, labels, mode)
    return labels


def write_labels(mesh: bpy.types.Mesh, labels: np.ndarray) -> None:
    """Write (F,) int32 labels of faces as results, and show their colours."""
    label_of_corner = np.repeat(labels, n_corners_of_polygon(mesh))
    write_attribute(mesh, PART, labels)
    write_attribute(mesh, PART_VERTEX, majority_label(label_of_corner, vertex_of_corner(mesh), len(mesh.vertices)))
    write_attribute(mesh, PART_COLOR, colours_of_labels(int(labels.max(initial=0)) + 1)[label_of_corner])
    _show_colours(mesh)
    mesh.update()


def majority_label(label_of_corner: np.ndarray, vertex_of_corner: np.ndarray, n_vertices: int) -> np.ndarray:
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


def forget_colours(mesh: bpy.types.Mesh) -> None:
    """Make the user's earlier colour attribute active again."""
    previous = mesh.get(PREVIOUS_COLOR)
    if previous is not None:
        del mesh[PREVIOUS_COLOR]
    if isinstance(previous, str) and previous in mesh.color_attributes:
        mesh.color_attributes.active_color_name = previous


def _show_colours(mesh: bpy.types.Mesh) -> None:
    active = mesh.color_attributes.active_color_name
    if active != PART_COLOR.name:
        if active:
            mesh[PREVIOUS_COLOR] = active
        mesh.color_attributes.active_color_name = PART_COLOR.name
