"""Write the parts of a mesh, with all that follows them: the face map, names, lists and outputs."""

from __future__ import annotations

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
    numbered = number_parts(parts, labels.parts)
    if isinstance(labels, compute.BranchLabels):
        numbered = with_swatches(numbered, compute.visible_parts(labels, part_tree))
    else:
        numbered = with_more_swatches(numbered, labels.parts)
    tables = packed_table(numbered, state.parts)
    division = division_of(of_faces, numbered, state.softness)
    shown = {schema.LEVEL: labels.level, schema.PARTS: packed(labels.parts)}
    items = state.corrections if items is None else items
    write_attributes(mesh, {PART: of_faces, **(attributes or {})})
    remember(mesh, {**shown, **tables, **changes})
    list_parts(mesh, labels.parts)
    list_corrections(mesh, items, labels.resting, numbered)
    output_registry.write(mesh, division, state.outputs)
    mesh.update()
