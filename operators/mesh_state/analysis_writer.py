"""Put an analysis on a mesh, with what of an earlier one goes on."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.attribute_types import Values
from ...tasks.mesh_analysis import BorderSource, StoredAnalysis
from ...tasks.mesh_shape import Stretch
from ...tasks.refusals import Refusal
from ..mesh_data.mesh_arrays import OwnAttribute, face_areas, fingerprint, write_attributes
from ..mesh_data.world_shape import stands_as, users_of
from . import corrections, function_hints
from .part_table import PartTable, packed_table, renumbered_table
from .schema import (
    ARCS,
    CHOICES,
    DESCRIPTION,
    EDGE_HEIGHTS,
    FINGERPRINT,
    LOST,
    OF_PARTS,
    OTHERWISE_SCALED,
    PAIRED_EDGE_HEIGHTS,
    PIECE,
    REDRAWN,
    SCHEMA,
    SHELLS,
    VERSION,
)
from .state import MeshState, read, remember, replace
from .stored_analysis import (
    branch_attributes,
    has_trees,
    packed_branches,
    packed_source,
    packed_stretch,
    packed_tree,
    place_attribute,
    source_attributes,
)


def store(
    mesh: bpy.types.Mesh,
    analysis: StoredAnalysis,
    source: BorderSource,
    description: str,
    hints: tuple[compute.FunctionHint, ...] = (),
    *,
    place_of_vertex: NDArray[np.int64],
    swatches: dict[int, int],
) -> tuple[str, ...]:
    """Put an analysis on the mesh it was made from, in place of an earlier one, and return warnings for the user.

    Parameters
    ----------
    place_of_vertex : (V,) int64
        The vertex that stands for each where several lie at one place along a seam.
    swatches : dict of int to int
        The place in the palette of the colour of each part.
    """
    earlier = read(mesh)
    part_tree = analysis.part_tree
    has_same_parts = has_trees(earlier.stored, part_tree.hierarchy)
    kept = _kept_by_number(earlier, analysis) if has_same_parts else _kept_by_place(earlier, analysis)
    items, painted, warnings = _kept_corrections(earlier, analysis, has_same_parts)
    values = {
        VERSION: SCHEMA,
        DESCRIPTION: description,
        SHELLS: analysis.shells,
        **packed_stretch(analysis.stretch),
        **packed_table(PartTable(swatches=swatches)),
        **kept,
        **corrections.packed_items(items),
        **packed_tree(part_tree),
        **packed_source(source),
        **function_hints.packed_hints(hints),
    }
    attributes = {
        **branch_attributes(part_tree.branches),
        **source_attributes(source),
        **place_attribute(place_of_vertex),
        **painted,
        PIECE: None,
    }
    write_attributes(mesh, attributes)
    replace(mesh, {**values, FINGERPRINT: fingerprint(mesh)})
    return (*warnings, *_otherwise_scaled(mesh, analysis.stretch))


def store_branches(
    mesh: bpy.types.Mesh, branches: tuple[compute.Branches, ...], place_of_vertex: NDArray[np.int64]
) -> None:
    """Put new faces of the arcs on a mesh whose faces were cut; its borders can be cut no more."""
    gone = dict.fromkeys((*ARCS, EDGE_HEIGHTS, PAIRED_EDGE_HEIGHTS, PIECE))
    write_attributes(mesh, {**branch_attributes(branches), **place_attribute(place_of_vertex), **gone})
    remember(mesh, {**packed_branches(branches), FINGERPRINT: fingerprint(mesh), REDRAWN: None})


def _kept(earlier: MeshState, names: tuple[str, ...]) -> dict[str, Any]:
    """Return what of an earlier state goes on with a new analysis, as it is stored."""
    values = {name: earlier.get(name) for name in names}
    return {
        name: value.to_dict() if hasattr(value, "to_dict") else value
        for name, value in values.items()
        if value is not None
    }


def _otherwise_scaled(mesh: bpy.types.Mesh, stretch: Stretch) -> tuple[str, ...]:
    """Return the warning about other objects with the mesh that have another shape in the world."""
    users = users_of(mesh)
    others = [obj for obj in users if not stands_as(obj, stretch)]
    return (OTHERWISE_SCALED.format(others[0].name),) if 0 < len(others) < len(users) else ()


def _kept_by_number(earlier: MeshState, analysis: StoredAnalysis) -> dict[str, Any]:
    """Return what goes on where parts have the same numbers."""
    kept, table = _kept(earlier, (*CHOICES, *OF_PARTS)), earlier.parts
    if earlier.registration is not None or not table.names:
        return kept
    return {**kept, **packed_table(table.with_pieces(earlier.pieces_of_parts(analysis.part_tree)))}


def _kept_by_place(earlier: MeshState, analysis: StoredAnalysis) -> dict[str, Any]:
    """Return the same where parts have other numbers: names and colours go where most of their faces went."""
    kept, table = _kept(earlier, CHOICES), earlier.parts
    if not (table.names or table.piece_names or table.colours):
        return kept
    try:
        before = earlier.analysis_of_any_shape.part_tree
    except Refusal:
        return kept
    numbers = {*table.places, *table.names, *table.colours}
    areas = face_areas(earlier.mesh, analysis.stretch)
    tracked = compute.tracked_parts(numbers, before, analysis.part_tree, areas, earlier.mode)
    if earlier.registration is None:
        table = table.with_pieces(earlier.pieces_of_parts(before))
    pieces = compute.tracked_pieces(table.piece_names, before, analysis.part_tree, areas, earlier.mode)
    return {**kept, **packed_table(renumbered_table(table, tracked, pieces))}


def _kept_corrections(
    earlier: MeshState, analysis: StoredAnalysis, has_same_parts: bool
) -> tuple[tuple[compute.Correction, ...], dict[OwnAttribute, Values | None], tuple[str, ...]]:
    """Return the earlier corrections with the numbers that their parts have now, faces painted anew, and warnings."""
    items = earlier.corrections
    if not items or has_same_parts:
        return items, {}, ()
    try:
        before = earlier.analysis_of_any_shape.part_tree
    except Refusal:
        return (), {}, (LOST,)
    part_tree = analysis.part_tree
    partners = compute.carried(items, before, part_tree, face_areas(earlier.mesh, analysis.stretch))
    painted = compute.carried_painting(earlier.painted, items, partners)
    kept = compute.renumbered(items, partners, before.hierarchy, part_tree.hierarchy)
    return kept, corrections.painted_attribute(painted), (LOST,) if len(kept) < len(items) else ()
