"""Write a segmentation to a mesh: the face map, the table of parts, and whatever outputs the user chose.

Each call reads once what the mesh remembers, computes, and then writes all or nothing.
"""

from __future__ import annotations

from typing import Unpack

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.level_choice import LevelChoice
from ...tasks.refusals import Refusal
from ..blender.known_values import present
from ..mesh_data.mesh_arrays import read_own_integers, refuse_foreign
from ..mesh_state import corrected_analysis, registration_record, schema
from ..mesh_state.corrections import packed_items, packed_redrawn, painted_attribute, redrawn_attribute
from ..mesh_state.part_table import PartTable, packed_table
from ..mesh_state.state import MeshState, read, remember
from ..mesh_state.validation import lie_within
from . import output_registry
from .division import PART, division_of
from .division_writer import write_parts
from .ownership import mend
from .rollback import all_or_nothing


def segment_mesh(
    mesh: bpy.types.Mesh, *, mode: str | None = None, **choice: Unpack[LevelChoice]
) -> compute.BranchLabels:
    """Divide an analyzed mesh into parts and write them.

    Parameters
    ----------
    mode : "nested", "features" or "jointed", optional
        The one that the mesh shows, if None.
    **choice
        One of ``level``, ``threshold`` and ``n_parts``, or none for the default level.

    Raises
    ------
    Refusal, EngineError
        If the mesh has no usable analysis or the level does not exist; nothing is changed then.
    """
    return segment(read(mesh), mode=mode, **choice)


def show_level(mesh: bpy.types.Mesh, level: int) -> compute.BranchLabels:
    """Divide an analyzed mesh into the parts of a level, the highest if it has not so many."""
    state = read(mesh)
    return segment(state, level=min(level, state.highest_level))


def show_mode(mesh: bpy.types.Mesh, mode: str) -> compute.BranchLabels:
    """Divide an analyzed mesh in another mode, at the level that it shows."""
    state = read(mesh)
    return segment(state, mode=mode, level=state.shown_level)


def segment(state: MeshState, *, mode: str | None = None, **choice: Unpack[LevelChoice]) -> compute.BranchLabels:
    """Divide an analyzed mesh into parts and write them; see ``segment_mesh``."""
    output_registry.refuse_foreign_results(state)
    analysis = corrected_analysis.corrected(state)
    mode = mode or state.mode
    labels = compute.label_branches(analysis.part_tree, mode=mode, corrections=analysis.corrections, **choice)
    attributes, changes = {}, {schema.MODE: mode, schema.REGISTRATION: None}
    if compute.needs_faces(state.corrections) and state.redrawn is None:
        redrawn = analysis.part_tree, present(analysis.corrections)
        attributes = redrawn_attribute(*redrawn)
        changes |= packed_redrawn(*redrawn)
    with all_or_nothing(state.mesh):
        write_parts(state, labels, analysis.part_tree, state.own_parts, changes, attributes=attributes)
    return labels


def correct(
    state: MeshState,
    items: tuple[compute.Correction, ...],
    *,
    changed: int | None = None,
    painted: NDArray[np.int64] | None = None,
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
    output_registry.refuse_foreign_results(state)
    corrected_analysis.refuse_uncorrectable(state)
    level, mode = state.level, state.mode
    painted = state.painted if painted is None else painted
    analysis = corrected_analysis.with_items(state, items, painted)
    labels = compute.label_branches(analysis.part_tree, level=level, mode=mode, corrections=analysis.corrections)
    if changed is not None and changed in labels.resting:
        raise Refusal(corrected_analysis.NO_EFFECT)
    redrawn = analysis.part_tree, present(analysis.corrections)
    attributes = {**painted_attribute(painted), **redrawn_attribute(*redrawn)}
    changes = {schema.MODE: mode, **packed_items(items), **packed_redrawn(*redrawn)}
    with all_or_nothing(state.mesh):
        write_parts(state, labels, analysis.part_tree, state.parts, changes, attributes=attributes, items=items)


def show_registered(
    mesh: bpy.types.Mesh,
    labels: compute.FaceLabels,
    part_tree: compute.PartTree,
    parts: PartTable,
    match: registration_record.Match,
    reference: bpy.types.Object | None = None,
    mode: str | None = None,
) -> None:
    """Show the parts of another mesh on an analyzed one.

    Parameters
    ----------
    parts : PartTable
        Names and colours of the reference's parts; the mesh keeps its own for later.
    match : Match
    reference : Object, optional
        None if it is in another file.
    mode : str, optional
        The one that the reference shows; the one that the mesh was last divided in if None.
    """
    state = read(mesh)
    registration = registration_record.packed_registration(match, reference, state.own_parts)
    write_parts(state, labels, part_tree, parts, {schema.MODE: mode or state.mode, **registration})


def write_outputs(mesh: bpy.types.Mesh, names: set[str] | None = None, softness: float | None = None) -> None:
    """Write the outputs of the parts that a mesh shows, and take back those that are not wanted any more.

    Parameters
    ----------
    names : set of str, optional
        Keys of ``OUTPUTS``; those that were chosen before if None.
    softness : float, optional
        Width over which vertex groups are softened, in the unit of the world; as before if None.
    """
    _rewrite(read(mesh), names=names, softness=softness)


def choose_output(mesh: bpy.types.Mesh, key: str, is_wanted: bool) -> None:
    """Write one output more, or take one back."""
    state = read(mesh)
    others = {output.key for output in output_registry.chosen(state.outputs)} - {key}
    _rewrite(state, names=others | ({key} if is_wanted else set()))


def rename_part(mesh: bpy.types.Mesh, part: int, name: str) -> None:
    """Give a part a name; an empty one brings its first name back."""
    state = read(mesh)
    _rewrite(state, parts=state.parts.renamed(part, name, _piece_of(state, part)))


def _piece_of(state: MeshState, part: int) -> int | None:
    """Return the piece of surface that a shown part is; None if it is the body, made by hand or of another mesh."""
    if state.registration is not None:
        return None
    try:
        return state.pieces_of_parts(state.analysis_of_any_shape.part_tree).get(part)
    except Refusal:
        return None


def colour_part(mesh: bpy.types.Mesh, part: int, colour: tuple[float, float, float]) -> None:
    """Give a part a colour of its own, in linear RGB."""
    state = read(mesh)
    _rewrite(state, parts=state.parts.coloured(part, colour))


def recolour(mesh: bpy.types.Mesh) -> None:
    """Give the outputs of a mesh that show colours those that its parts have by now."""
    state = read(mesh)
    division = division_of(read_labels(mesh), state.parts, state.softness)
    output_registry.write_coloured(mesh, division, state.outputs)
    mesh.update()


def read_labels(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the (F,) int32 part of each face; raises a Refusal if they are gone or cannot be parts."""
    labels = read_own_integers(mesh, PART)
    if not lie_within(labels, 0, schema.MOST_LABELS):
        raise Refusal(schema.DAMAGED)
    return labels


def _rewrite(
    state: MeshState,
    *,
    names: set[str] | None = None,
    softness: float | None = None,
    parts: PartTable | None = None,
) -> None:
    """Write the outputs of the parts that a mesh shows with what is given; the rest is as it was."""
    mend(state.mesh, output_registry.result_attributes(state.outputs))
    state.refuse_unreadable()
    outputs = output_registry.chosen(state.outputs if names is None else tuple(names))
    unwanted = tuple(output for output in output_registry.chosen(state.outputs) if output not in outputs)
    refuse_foreign(state.mesh, output_registry.attributes_of(outputs))
    softness = state.softness if softness is None else softness
    parts = state.parts if parts is None else parts
    division = division_of(read_labels(state.mesh), parts, softness)
    keys = tuple(output.key for output in outputs)
    with all_or_nothing(state.mesh):
        output_registry.remove(state.mesh, unwanted)
        choice = output_registry.packed_choice(keys, softness)
        remember(state.mesh, {**choice, **packed_table(parts, state.parts)})
        output_registry.write(state.mesh, division, keys)
    state.mesh.update()
