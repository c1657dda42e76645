"""The lists of parts and corrections that the panel shows; the command line does without them."""

from __future__ import annotations

import bpy

from ... import compute
from ..blender.registered_settings import mesh_settings
from ..mesh_state.part_table import PartTable, in_tree_order


def list_parts(mesh: bpy.types.Mesh, parts: compute.Parts) -> None:
    """Fill the list of parts."""
    if not hasattr(mesh, "eigenparts"):
        return
    rows = mesh_settings(mesh).rows
    rows.clear()
    whole = parts.area.sum()
    for place, depth in in_tree_order(parts):
        row = rows.add()
        row.part, row.depth = int(parts.id[place]), depth
        row.share, row.n_faces = parts.area[place] / whole, int(parts.n_triangles[place])


def list_corrections(
    mesh: bpy.types.Mesh, items: tuple[compute.Correction, ...], resting: tuple[int, ...], parts: PartTable
) -> None:
    """Fill the list of corrections; those that rest do nothing at the level that is shown."""
    if not hasattr(mesh, "eigenparts"):
        return
    rows = mesh_settings(mesh).correction_rows
    rows.clear()
    for place, item in enumerate(items):
        row = rows.add()
        row.place, row.rests = place, place in resting
        row.title = described(item, parts)


def described(item: compute.Correction, parts: PartTable) -> str:
    """Return what a correction does, in words."""
    part, other = (parts.name_of(number) for number in (item.part, item.other))
    sentences = {
        compute.LEVEL: f"{part}: level {int(item.value)}",
        compute.MERGE: f"{part} joined to {other}",
        compute.SPLIT: f"{part} split, {other} beyond",
        compute.MOVE: f"{part}: border {item.value:+.1%}",
        compute.PAINT: f"{part}: painted faces",
    }
    return sentences[item.kind]
