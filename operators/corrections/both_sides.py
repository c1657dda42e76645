"""Corrections of a part that its twin gets too, in whatever pose: all of it or nothing."""

from __future__ import annotations

from collections.abc import Callable

from ... import compute
from ..mesh_state.schema import PARTS
from ..mesh_state.serialization import UNREADABLE, unpacked_array
from ..mesh_state.state import MeshState, read
from ..outputs.rollback import all_or_nothing

# Borders that were split off at the same position of twins lie this near to each other, as fractions of the range.
SAME_PLACE = 0.05
MIRROR = "Do the same to the part that mirrors this one on a symmetric shape, in any pose"


def correct_both(state: MeshState, part: int, mirror: bool, correct: Callable[[MeshState, int], object]) -> None:
    """Correct a part and, if it is to be mirrored and has one, its twin.

    Parameters
    ----------
    correct : callable
        Takes the state of the mesh and the part.
    """
    twin = twin_of(state, part) if mirror else None
    if twin is None:
        correct(state, part)
        return
    with all_or_nothing(state.mesh):
        correct(state, part)
        correct(read(state.mesh), twin)


def twin_of(state: MeshState, part: int) -> int | None:
    """Return the part that mirrors a part, None if there is none; of what was split off, what was split off there."""
    made = next((item for item in state.corrections if item.kind == compute.SPLIT and item.other == part), None)
    if made is None:
        return _twins(state).get(part)
    twin = twin_of(state, made.part)
    mirrored = (
        item.other
        for item in state.corrections
        if item.kind == compute.SPLIT and item.part == twin and abs(item.value - made.value) < SAME_PLACE
    )
    return next(mirrored, None)


def _twins(state: MeshState) -> dict[int, int]:
    """Return the twin of each part that is shown and has one; nothing for what an earlier version has stored."""
    try:
        parts = state.readable[PARTS]
        ids, mirror = (unpacked_array(parts[name], "int64").tolist() for name in ("id", "mirror"))
        return {part: twin for part, twin in zip(ids, mirror, strict=True) if twin in ids}
    except UNREADABLE:
        return {}
