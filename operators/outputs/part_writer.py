"""Write a segmentation to a mesh: the face map, the table of parts, and whatever outputs the user chose."""

from __future__ import annotations

import bpy
import numpy as np

from ... import compute
from ..mesh_data.mesh_arrays import read_own_integers, refuse_foreign, write_attribute
from ..mesh_state import corrected_analysis, corrections, part_table, registration_record, state
from ..mesh_state.validation import lie_within
from ..messages.user_errors import Refusal
from . import output_registry
from .division import PART
from .ownership import mend
from .rollback import all_or_nothing


def segment_mesh(mesh: bpy.types.Mesh, *, mode: str | None = None, **choice: float) -> compute.BranchLabels:
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
    refuse_foreign_results(mesh)
    analysis = corrected_analysis.load(mesh)
    mode = mode or state.mode_of(mesh)
    labels = compute.label_branches(analysis.part_tree, mode=mode, corrections=analysis.corrections, **choice)
    with all_or_nothing(mesh):
        registration_record.take_back(mesh)
        show_labels(mesh, labels, analysis.part_tree, mode)
    return labels


def correct_mesh(
    mesh: bpy.types.Mesh,
    items: tuple[compute.Correction, ...],
    *,
    changed: int | None = None,
    painted: np.ndarray | None = None,
) -> None:
    """Give an analyzed mesh other corrections, and show its parts at the level that it shows.

    Parameters
    ----------
    items : tuple of Correction
        All of them.
    changed : int, optional
        The place of one that has to have an effect.
    painted : (F,) int64, optional
        The part each face is painted with, -1 elsewhere; as before if None.

    Raises
    ------
    Refusal, EngineError
        If the mesh cannot be corrected, or the change has no effect; nothing is changed then.
    """
    refuse_foreign_results(mesh)
    corrected_analysis.refuse_uncorrectable(mesh)
    level, mode = state.summarize(mesh).level, state.mode_of(mesh)
    painted = corrections.read_painted(mesh) if painted is None else painted
    analysis = corrected_analysis.with_items(mesh, state.load(mesh), items, painted)
    labels = compute.label_branches(analysis.part_tree, level=level, mode=mode, corrections=analysis.corrections)
    if changed is not None and changed in labels.resting:
        raise Refusal(corrected_analysis.NO_EFFECT)
    with all_or_nothing(mesh):
        corrected_analysis.store(mesh, analysis, painted)
        show_labels(mesh, labels, analysis.part_tree, mode)


def show_labels(mesh: bpy.types.Mesh, labels: compute.BranchLabels, part_tree: compute.PartTree, mode: str) -> None:
    """Write parts to an analyzed mesh, and everything that follows them."""
    of_faces = labels.of_faces(part_tree)
    write_attribute(mesh, PART, of_faces)
    state.remember_segmentation(mesh, labels, mode)
    part_table.number_parts(mesh, labels.parts)
    _list_parts(mesh, labels.parts)
    _list_corrections(mesh, labels.resting)
    output_registry.write(mesh, of_faces)
    mesh.update()


def write_outputs(mesh: bpy.types.Mesh, names: set[str] | None = None, softness: float | None = None) -> None:
    """Write the outputs of the parts that a mesh shows, and take back those that are not wanted any more.

    Parameters
    ----------
    names : set of str, optional
        Keys of ``outputs.OUTPUTS``; those that were chosen before if None.
    softness : float, optional
        Width over which vertex groups are softened, in the mesh's unit; as before if None.
    """
    mend(mesh)
    state.summarize(mesh)
    names = set(output_registry.chosen(mesh)) if names is None else names
    refuse_foreign(mesh, output_registry.own_attributes(names))
    labels = read_labels(mesh)
    with all_or_nothing(mesh):
        output_registry.choose(mesh, names, output_registry.softness(mesh) if softness is None else softness)
        output_registry.write(mesh, labels)
    mesh.update()


def rename_part(mesh: bpy.types.Mesh, part: int, name: str) -> None:
    """Give a part a name; an empty one brings its first name back."""
    state.summarize(mesh)
    with all_or_nothing(mesh):
        part_table.rename(mesh, part, name)
        write_outputs(mesh)


def colour_part(mesh: bpy.types.Mesh, part: int, colour: tuple[float, float, float]) -> None:
    """Give a part a colour of its own, in linear RGB."""
    state.summarize(mesh)
    with all_or_nothing(mesh):
        part_table.set_colour(mesh, part, colour)
        write_outputs(mesh)


def recolour(mesh: bpy.types.Mesh) -> None:
    """Give the outputs of a mesh that show colours those that its parts have by now."""
    output_registry.write(mesh, read_labels(mesh), output_registry.COLOURED)
    mesh.update()


def refuse_foreign_results(mesh: bpy.types.Mesh) -> None:
    """Raise a Refusal if something of the user's stands where a result belongs."""
    mend(mesh)
    refuse_foreign(mesh, (PART, *state.ATTRIBUTES, *output_registry.own_attributes(output_registry.chosen(mesh))))


def read_labels(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the (F,) int32 part of each face; raises a Refusal if they are gone or cannot be parts."""
    labels = read_own_integers(mesh, PART)
    if not lie_within(labels, 0, state.MOST_LABELS):
        raise Refusal(state.DAMAGED)
    return labels


def _list_parts(mesh: bpy.types.Mesh, parts: compute.Parts) -> None:
    """Fill the list that the panel shows."""
    if not hasattr(mesh, "eigenparts"):
        # The command line does without the extension's properties.
        return
    rows = mesh.eigenparts.rows
    rows.clear()
    whole = parts.area.sum()
    for place, depth in part_table.in_tree_order(parts):
        row = rows.add()
        row.part, row.depth = int(parts.id[place]), depth
        row.share, row.n_faces = parts.area[place] / whole, int(parts.n_triangles[place])


def _list_corrections(mesh: bpy.types.Mesh, resting: tuple[int, ...]) -> None:
    """Fill the list of corrections that the panel shows."""
    if not hasattr(mesh, "eigenparts"):
        return
    rows = mesh.eigenparts.correction_rows
    rows.clear()
    for place, item in enumerate(corrected_analysis.items_of(mesh)):
        row = rows.add()
        row.place, row.rests = place, place in resting
        row.title = corrected_analysis.described(mesh, item)
