"""Corrections by hand as they are stored: plain numbers in the state, and the part of each painted face."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.attribute_types import Values
from ..mesh_data.mesh_arrays import OwnAttribute, own_names, read_own_integers
from .schema import CORRECTIONS, PAINTED, PIECE, REDRAWN, TREE
from .serialization import UNREADABLE, packed_array, unpacked_array
from .stored_analysis import packed_branches, unpacked_branches
from .validation import are_sound_branches, lie_within

# More parts of one's own than anybody makes by hand.
MOST_OWN_PARTS = 1000
# Columns of a stored correction.
COLUMNS = ("kind", "part", "other", "value", "level", "mode")


def unpacked_items(stored: Any) -> tuple[compute.Correction, ...]:
    """Return the corrections in a state, as far as they make sense; cheap enough for every redraw."""
    group: Any = stored.get(CORRECTIONS) if hasattr(stored, "to_dict") else None
    if not hasattr(group, "to_dict"):
        return ()
    rows = [group[name] for name in sorted(filter(str.isdecimal, group.keys()), key=int)]
    items = [_item(row) for row in rows if hasattr(row, "to_dict")]
    n_numbers = _n_numbers(stored) if items else 0
    return tuple(item for item in items if item is not None and _makes_sense(item, n_numbers))


def packed_items(items: tuple[compute.Correction, ...]) -> dict[str, Any]:
    """Return corrections as a group of the state."""
    rows = {str(row): {name: getattr(item, name) for name in COLUMNS} for row, item in enumerate(items)}
    return {CORRECTIONS: rows}


def read_painted(mesh: bpy.types.Mesh) -> NDArray[np.int64]:
    """Return the (F,) int64 part each face was painted with, -1 elsewhere."""
    if PAINTED.name not in own_names(mesh) or PAINTED.name not in mesh.attributes:
        return np.full(len(mesh.polygons), -1)
    return read_own_integers(mesh, PAINTED).astype(np.int64) - 1


def painted_attribute(painted: NDArray[np.int64]) -> dict[OwnAttribute, Values | None]:
    """Return the part of each painted face as an attribute; None where no face is painted."""
    return {PAINTED: (painted + 1).astype(np.int32) if (painted >= 0).any() else None}


def redrawn_attribute(
    part_tree: compute.PartTree, corrections: compute.Corrections
) -> dict[OwnAttribute, Values | None]:
    """Return the branch of each face as corrections divide them; None where they divide no face."""
    return {PIECE: part_tree.branches[0].of_face if compute.needs_faces(corrections.items) else None}


def packed_redrawn(part_tree: compute.PartTree, corrections: compute.Corrections) -> dict[str, Any]:
    """Return what goes into the state beside ``redrawn_attribute``; None where no face is divided."""
    if not compute.needs_faces(corrections.items):
        return {REDRAWN: None}
    sides = {"side": packed_array(corrections.side), "painted": packed_array(corrections.painted)}
    return {REDRAWN: {**packed_branches(part_tree.branches), **sides}}


def read_redrawn(
    mesh: bpy.types.Mesh, stored: Any, part_tree: compute.PartTree, items: tuple[compute.Correction, ...]
) -> tuple[compute.PartTree, compute.Corrections] | None:
    """Return a part tree with its redrawn branches; None if they are not there, or damaged."""
    group = stored.get(REDRAWN)
    if not hasattr(group, "to_dict") or PIECE.name not in own_names(mesh) or PIECE.name not in mesh.attributes:
        return None
    try:
        branches = unpacked_branches(group, [read_own_integers(mesh, PIECE)] * len(part_tree.trees))
        side, painted = unpacked_array(group["side"], "int64"), unpacked_array(group["painted"], "int64")
        n_branches = branches[0].arc.size
        is_sound = (
            side.shape == (len(items), n_branches)
            and painted.shape == (n_branches,)
            and lie_within(painted, -1, _n_numbers(stored))
            and all(
                pieces.arc.size == n_branches and are_sound_branches(pieces, tree.parent.size)
                for pieces, tree in zip(branches, part_tree.trees, strict=True)
            )
        )
    except UNREADABLE:
        return None
    return (replace(part_tree, branches=branches), compute.Corrections(items, side, painted)) if is_sound else None


def _n_numbers(stored: Any) -> int:
    """Return a number above that of any part: those of levels, and those that were made by hand."""
    try:
        tree = stored[TREE.format(0)]
        numbers = (int(tree["n_roots"]), int(tree["n_features"]), int(tree.get("n_necks", 0)))
        return compute.number_behind(*numbers) + MOST_OWN_PARTS
    except UNREADABLE:
        return MOST_OWN_PARTS


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
        and item.mode in compute.READINGS
        and math.isfinite(item.value)
        and item.level >= 0
        and 0 <= item.part < n_numbers
        and 0 <= item.other < n_numbers
        and (item.kind != compute.LEVEL or 0 <= item.value < 2**31)
    )
