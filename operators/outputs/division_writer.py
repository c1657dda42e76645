"""Write the parts of a mesh, with all that follows them: the face map, names, lists and outputs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ... import compute
from ...tasks.attribute_types import Values
from ..mesh_data.mesh_arrays import OwnAttribute, write_attributes
from ..mesh_state import schema
from ..mesh_state.part_table import PartTable, number_parts, packed_table, with_more_swatches, with_swatches
from ..mesh_state.serialization import packed
from ..mesh_state.state import MeshState, remember
from . import output_registry
from .division import PART, division_of
from .part_rows import list_corrections, list_parts


def write_parts(
    state: MeshState,
    labels: compute.BranchLabels | compute.FaceLabels,
    part_tree: compute.PartTree,
    parts: PartTable,
    changes: dict[str, Any],
    *,
    attributes: dict[OwnAttribute, Values | None] | None = None,
    items: tuple[compute.Correction, ...] | None = None,
) -> None:
    """Write parts to an analyzed mesh, and everything that follows them.

    Parameters
    ----------
    parts : PartTable
        In which new parts get their places.
    changes : dict
        What the mesh is to remember beside them.
    attributes : dict, optional
        What is written to attributes of ours beside the face map.
    items : tuple of Correction, optional
        Those that the parts come from; those of the state if None.
    """
    mesh, of_faces = state.mesh, labels.of_faces(part_tree)
    items = state.corrections if items is None else items
    mode = changes.get(schema.MODE, state.mode)
    numbered = number_parts(_with_names(parts, state, labels, part_tree, mode, items), labels.parts)
    if isinstance(labels, compute.BranchLabels):
        numbered = with_swatches(numbered, compute.visible_parts(labels, part_tree))
    else:
        numbered = with_more_swatches(numbered, labels.parts)
    tables = packed_table(numbered, state.parts)
    division = division_of(of_faces, numbered, state.softness)
    shown = {schema.LEVEL: labels.level, schema.PARTS: packed(labels.parts)}
    write_attributes(mesh, {PART: of_faces, **(attributes or {})})
    remember(mesh, {**shown, **tables, **changes})
    list_parts(mesh, labels.parts)
    list_corrections(mesh, items, labels.resting, numbered)
    output_registry.write(mesh, division, state.outputs)
    mesh.update()


def _with_names(
    parts: PartTable,
    state: MeshState,
    labels: compute.BranchLabels | compute.FaceLabels,
    part_tree: compute.PartTree,
    mode: str,
    items: tuple[compute.Correction, ...],
) -> PartTable:
    """Return the table with the names of the pieces that the parts are now."""
    if not isinstance(labels, compute.BranchLabels):
        # The parts of a reference, whose pieces are not this mesh's.
        return replace(parts, piece_names={})
    if not (parts.names or parts.piece_names):
        return parts
    named = parts.with_pieces(state.pieces_of_parts(part_tree))
    pieces = part_tree.pieces_of_parts(labels.level, mode, compute.Corrections(items).branch_levels)
    return named.shown_as(pieces, compute.first_own_part(part_tree.trees[0]))
