"""Corrections by hand on an analyzed mesh: read with all that levels need, and changed."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ... import compute
from ..mesh_data.mesh_arrays import read_mesh
from ..messages.user_errors import Refusal
from . import corrections, part_table, registration_record, state

REGISTERED = "The mesh shows the parts of another object; move its level first, so that it has parts of its own."
NO_EFFECT = "That changes nothing here; the mesh was left as it is."


def load(mesh: bpy.types.Mesh) -> state.StoredAnalysis:
    """Return the analysis of a mesh with its corrections; raises a Refusal if there is none that can be used."""
    analysis = state.load(mesh)
    items = corrections.read(mesh[state.STATE])
    if not items or not compute.needs_faces(items):
        return with_items(mesh, analysis, items)
    pieces = corrections.read_pieces(mesh, mesh[state.STATE], analysis.part_tree, items)
    if pieces is not None:
        part_tree, corrected = pieces
        return replace(analysis, part_tree=part_tree, corrections=corrected)
    redrawn = with_items(mesh, analysis, items)
    corrections.write_pieces(mesh, mesh[state.STATE], redrawn.part_tree, redrawn.corrections)
    return redrawn


def with_items(
    mesh: bpy.types.Mesh,
    analysis: state.StoredAnalysis,
    items: tuple[compute.Correction, ...],
    painted: np.ndarray | None = None,
) -> state.StoredAnalysis:
    """Return an analysis as ``state.load`` gives it with some corrections; nothing is written.

    Parameters
    ----------
    painted : (F,) int64, optional
        The part each face is painted with, -1 elsewhere; as on the mesh if None.
    """
    if not compute.needs_faces(items):
        return replace(analysis, corrections=compute.undivided(analysis.part_tree, items))
    painted = corrections.read_painted(mesh) if painted is None else painted
    graph, relief = _faces_of(mesh)
    part_tree, corrected = compute.redraw(analysis.part_tree, items, painted, relief, graph)
    return replace(analysis, part_tree=part_tree, corrections=corrected)


def store(mesh: bpy.types.Mesh, analysis: state.StoredAnalysis, painted: np.ndarray) -> None:
    """Write the corrections of an analysis and what levels need of them."""
    items = analysis.corrections.items
    mesh[state.STATE][corrections.CORRECTIONS] = corrections.packed_items(items)
    corrections.write_painted(mesh, painted)
    if compute.needs_faces(items):
        corrections.write_pieces(mesh, mesh[state.STATE], analysis.part_tree, analysis.corrections)
    else:
        corrections.drop_pieces(mesh, mesh[state.STATE])


def items_of(mesh: bpy.types.Mesh) -> tuple[compute.Correction, ...]:
    """Return the corrections of an analyzed mesh."""
    return corrections.read(mesh.get(state.STATE))


def crossings(mesh: bpy.types.Mesh, source: state.BorderSource) -> tuple[compute.EdgeProfile, compute.Crossings]:
    """Return where the borders of the parts that a mesh shows cross its edges, and the arcs these refer to."""
    whole, analysis = state.load(mesh).part_tree, load(mesh)
    level, mode = state.summarize(mesh).level, state.mode_of(mesh)
    corrected = analysis.corrections or compute.Corrections()
    labels = compute.label_branches(analysis.part_tree, level=level, mode=mode, corrections=corrected)
    drawn = ()
    if compute.needs_faces(corrected.items):
        _, relief = _faces_of(mesh)
        try:
            drawn = compute.drawn_borders(whole, corrected, labels.resting, relief)
        except LookupError as error:
            # A level that a correction says it was made at has not the part it changes.
            raise Refusal(state.DAMAGED) from error
    cuts = whole.cut_arcs(level, mode, corrected.branch_levels)
    joined = compute.joined_parts(corrected, labels.resting)
    return compute.corrected_crossings(source.profile, whole, cuts, drawn, joined)


def described(mesh: bpy.types.Mesh, item: compute.Correction) -> str:
    """Return what a correction does, in words."""
    part, other = (part_table.name_of(mesh, number) for number in (item.part, item.other))
    sentences = {
        compute.LEVEL: f"{part}: level {int(item.value)}",
        compute.MERGE: f"{part} joined to {other}",
        compute.SPLIT: f"{part} split, {other} beyond",
        compute.MOVE: f"{part}: border {item.value:+.1%}",
        compute.PAINT: f"{part}: painted faces",
    }
    return sentences[item.kind]


def peak_within(mesh: bpy.types.Mesh, item: compute.Correction, faces: np.ndarray) -> float:
    """Return how far some faces (F,) rise above the border of a part, as a fraction of the field's range.

    Raises
    ------
    Refusal
        If the part has no border along the field.
    """
    hill = _hill(mesh, item)
    _, relief = _faces_of(mesh)
    return hill.upward * (relief.peak(hill, faces) - hill.border) / state.load(mesh).part_tree.hierarchy.value_range


def refuse_without_border(mesh: bpy.types.Mesh, item: compute.Correction) -> None:
    """Raise a Refusal if the part of a correction does not end along the field."""
    _hill(mesh, item)


def _hill(mesh: bpy.types.Mesh, item: compute.Correction) -> compute.Hill:
    part_tree = state.load(mesh).part_tree
    items = corrections.read(mesh[state.STATE])
    try:
        return compute.hill_of(part_tree, items, item)
    except LookupError:
        raise Refusal("This part has no border along the field; assign faces to it instead.") from None


def refuse_uncorrectable(mesh: bpy.types.Mesh) -> None:
    """Raise a Refusal if the parts that a mesh shows are not its own."""
    if registration_record.read(mesh) is not None:
        raise Refusal(REGISTERED)


def free_part(hierarchy: compute.Hierarchy, items: tuple[compute.Correction, ...]) -> int:
    """Return a number for a part of one's own."""
    first = compute.first_own_part(hierarchy.trees[0])
    taken = max((number for item in items for number in (item.part, item.other)), default=0)
    if taken >= first + corrections.MOST_OWN_PARTS - 1:
        raise Refusal("There are too many corrections; remove some first.")
    return max(first, taken + 1)


def _faces_of(mesh: bpy.types.Mesh) -> tuple[compute.FaceGraph, compute.Relief]:
    arrays = read_mesh(mesh)
    triangles = compute.TriangleMesh(arrays.vertices, arrays.triangles)
    surface = compute.analyzed_surface(triangles, state.shells_of(mesh))
    graph = compute.face_graph(triangles, surface, arrays.polygon_of_triangle)
    heights = state.vertex_heights(mesh)
    return graph, compute.relief_of(surface, heights, arrays.polygon_of_triangle, graph.stands_for)
