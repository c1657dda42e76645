"""Put an analysis on a mesh, with what of an earlier one goes on."""

from __future__ import annotations

from typing import Any

import bpy

from ... import compute
from ..mesh_data.attribute_values import Values
from ..mesh_data.mesh_arrays import OwnAttribute, face_areas, fingerprint, write_attributes
from ..messages.user_errors import Refusal
from . import corrections, function_hints
from .schema import (
    ARCS,
    CHOICES,
    DESCRIPTION,
    EDGE_HEIGHTS,
    FINGERPRINT,
    LOST,
    OF_PARTS,
    PIECE,
    REDRAWN,
    SCHEMA,
    SHELLS,
    VERSION,
)
from .state import MeshState, read, remember, replace
from .stored_analysis import (
    BorderSource,
    StoredAnalysis,
    branch_attributes,
    has_trees,
    packed_branches,
    packed_source,
    packed_tree,
    source_attributes,
)


def store(
    mesh: bpy.types.Mesh,
    analysis: StoredAnalysis,
    source: BorderSource,
    description: str,
    hints: tuple[compute.FunctionHint, ...] = (),
) -> tuple[str, ...]:
    """Put an analysis on the mesh it was made from, in place of an earlier one, and return warnings for the user."""
    earlier = read(mesh)
    part_tree = analysis.part_tree
    has_same_parts = has_trees(earlier.stored, part_tree.hierarchy)
    kept = _kept(earlier, (*CHOICES, *OF_PARTS) if has_same_parts else CHOICES)
    items, painted, warnings = _kept_corrections(earlier, part_tree, has_same_parts)
    values = {
        VERSION: SCHEMA,
        DESCRIPTION: description,
        SHELLS: analysis.shells,
        **kept,
        **corrections.packed_items(items),
        **packed_tree(part_tree),
        **packed_source(source),
        **function_hints.packed_hints(hints),
    }
    write_attributes(
        mesh, {**branch_attributes(part_tree.branches), **source_attributes(source), **painted, PIECE: None}
    )
    replace(mesh, {**values, FINGERPRINT: fingerprint(mesh)})
    return warnings


def store_branches(mesh: bpy.types.Mesh, branches: tuple[compute.Branches, ...]) -> None:
    """Put new faces of the arcs on a mesh whose faces were cut; its borders can be cut no more."""
    gone = dict.fromkeys((*ARCS, EDGE_HEIGHTS, PIECE))
    write_attributes(mesh, {**branch_attributes(branches), **gone})
    remember(mesh, {**packed_branches(branches), FINGERPRINT: fingerprint(mesh), REDRAWN: None})


def _kept(earlier: MeshState, names: tuple[str, ...]) -> dict[str, Any]:
    """Return what of an earlier state goes on with a new analysis, as it is stored."""
    values = {name: earlier.get(name) for name in names}
    return {
        name: value.to_dict() if hasattr(value, "to_dict") else value
        for name, value in values.items()
        if value is not None
    }


def _kept_corrections(
    earlier: MeshState, part_tree: compute.PartTree, has_same_parts: bool
) -> tuple[tuple[compute.Correction, ...], dict[OwnAttribute, Values | None], tuple[str, ...]]:
    """Return the earlier corrections with the numbers that their parts have now, faces painted anew, and warnings."""
    items = earlier.corrections
    if not items or has_same_parts:
        return items, {}, ()
    try:
        before = earlier.analysis_of_any_shape.part_tree
    except Refusal:
        return (), {}, (LOST,)
    partners = compute.carried(items, before, part_tree, face_areas(earlier.mesh))
    painted = compute.carried_painting(earlier.painted, items, partners)
    kept = compute.renumbered(items, partners, before.hierarchy, part_tree.hierarchy)
    return kept, corrections.painted_attribute(painted), (LOST,) if len(kept) < len(items) else ()
