"""What is stored of corrections by hand: plain numbers in the state, and the part of each painted face."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ... import compute
from ..mesh_data.mesh_arrays import OwnAttribute, own_names, read_own_integers, remove_own_attributes, write_attribute
from .serialization import UNREADABLE, packed, packed_array, unpacked, unpacked_array
from .validation import are_sound_branches, lie_within

# Groups of the state.
CORRECTIONS, PIECES = "corrections", "pieces"
# The part each face was painted with and one more, so that 0 is none.
PAINTED = OwnAttribute("eigenparts_painted", "INT", "FACE")
# The branches divided as corrections need them; the attribute is there only while some do.
PIECE = OwnAttribute(".eigenparts_piece", "INT", "FACE")
ATTRIBUTES = (PAINTED, PIECE)
# More parts of one's own than anybody makes by hand.
MOST_OWN_PARTS = 1000


def read(state: Any) -> tuple[compute.Correction, ...]:
    """Return the corrections in a state, as far as they make sense; cheap enough for every redraw."""
    group = state.get(CORRECTIONS) if hasattr(state, "to_dict") else None
    if not hasattr(group, "to_dict"):
        return ()
    rows = [group[name] for name in sorted(filter(str.isdecimal, group.keys()), key=int)]
    items = [_item(row) for row in rows if hasattr(row, "to_dict")]
    n_numbers = first_own_part(state) + MOST_OWN_PARTS
    return tuple(item for item in items if item is not None and _makes_sense(item, n_numbers))


def first_own_part(state: Any) -> int:
    """Return the least number that no part of any level has."""
    try:
        return compute.number_behind(int(state["tree_0"]["n_roots"]), int(state["tree_0"]["n_features"]))
    except UNREADABLE:
        return 0


def packed_items(items: tuple[compute.Correction, ...]) -> dict[str, dict[str, Any]]:
    """Return corrections as a group of the state."""
    names = ("kind", "part", "other", "value", "level", "mode")
    return {str(row): {name: getattr(item, name) for name in names} for row, item in enumerate(items)}


def read_painted(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the (F,) int64 part each face was painted with, -1 elsewhere."""
    if PAINTED.name not in own_names(mesh) or PAINTED.name not in mesh.attributes:
        return np.full(len(mesh.polygons), -1)
    return read_own_integers(mesh, PAINTED).astype(np.int64) - 1


def write_painted(mesh: bpy.types.Mesh, painted: np.ndarray) -> None:
    """Store the part of each painted face; nothing is left where none is."""
    if (painted >= 0).any():
        write_attribute(mesh, PAINTED, (painted + 1).astype(np.int32))
    else:
        remove_own_attributes(mesh, [PAINTED.name])


def write_pieces(
    mesh: bpy.types.Mesh, state: Any, part_tree: compute.PartTree, corrections: compute.Corrections
) -> None:
    """Store branches that were divided for corrections."""
    tables = {
        **{f"branches_{i}": packed(pieces) for i, pieces in enumerate(part_tree.branches)},
        "side": packed_array(corrections.side),
        "painted": packed_array(corrections.painted),
    }
    # Without their tables pieces are made again, so whatever fails from here on leaves nothing that is not true.
    if PIECES in state:
        del state[PIECES]
    write_attribute(mesh, PIECE, part_tree.branches[0].of_face)
    state[PIECES] = tables


def drop_pieces(mesh: bpy.types.Mesh, state: Any) -> None:
    """Forget divided branches: there is no need for them, or they are not true any more."""
    remove_own_attributes(mesh, [PIECE.name])
    if PIECES in state:
        del state[PIECES]


def read_pieces(
    mesh: bpy.types.Mesh, state: Any, part_tree: compute.PartTree, items: tuple[compute.Correction, ...]
) -> tuple[compute.PartTree, compute.Corrections] | None:
    """Return a part tree with divided branches; None if they are not there or damaged and have to be made again."""
    group = state.get(PIECES)
    if not hasattr(group, "to_dict") or PIECE.name not in own_names(mesh) or PIECE.name not in mesh.attributes:
        return None
    try:
        of_face = read_own_integers(mesh, PIECE)
        branches = tuple(
            compute.Branches(of_face=of_face, **unpacked(group[f"branches_{i}"], compute.Branches))
            for i in range(len(part_tree.trees))
        )
        side, painted = unpacked_array(group["side"], "int64"), unpacked_array(group["painted"], "int64")
        n_branches = branches[0].arc.size
        is_sound = (
            side.shape == (len(items), n_branches)
            and painted.shape == (n_branches,)
            and lie_within(painted, -1, first_own_part(state) + MOST_OWN_PARTS)
            and all(
                pieces.arc.size == n_branches and are_sound_branches(pieces, tree.parent.size)
                for pieces, tree in zip(branches, part_tree.trees, strict=True)
            )
        )
    except UNREADABLE:
        return None
    return (replace(part_tree, branches=branches), compute.Corrections(items, side, painted)) if is_sound else None


def carry_over(
    mesh: bpy.types.Mesh,
    items: tuple[compute.Correction, ...],
    old: compute.PartTree,
    new: compute.PartTree,
    area: np.ndarray,
) -> tuple[compute.Correction, ...]:
    """Return corrections for another analysis of the mesh, and repaint its faces with the new numbers."""
    found = compute.carried(items, old, new, area)
    write_painted(mesh, compute.carried_painting(read_painted(mesh), items, found))
    return compute.renumbered(items, found, old.hierarchy, new.hierarchy)


def _item(row: Any) -> compute.Correction | None:
    try:
        return compute.Correction(
            str(row["kind"]),
            int(row["part"]),
            int(row["other"]),
            float(row["value"]),
            int(row["level"]),
            str(row["mode"]),
        )
    except UNREADABLE:
        return None


def _makes_sense(item: compute.Correction, n_numbers: int) -> bool:
    return (
        item.kind in compute.CORRECTION_KINDS
        and item.mode in compute.MODES
        and math.isfinite(item.value)
        and item.level >= 0
        and 0 <= item.part < n_numbers
        and 0 <= item.other < n_numbers
        and (item.kind != compute.LEVEL or 0 <= item.value < 2**31)
    )
