"""The analysis of a mesh with its corrections by hand: all that levels need."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_analysis import BorderSource, StoredAnalysis
from ...tasks.refusals import Refusal
from .corrections import MOST_OWN_PARTS
from .schema import DAMAGED
from .state import MeshState

REGISTERED = "The mesh shows the parts of another object; move its level first, so that it has parts of its own."
NO_EFFECT = "That changes nothing here; the mesh was left as it is."


def corrected(state: MeshState) -> StoredAnalysis:
    """Return the analysis of a mesh with its corrections; raises a Refusal if there is none that can be used."""
    analysis, items = state.analysis, state.corrections
    if not compute.needs_faces(items) or state.redrawn is None:
        return with_items(state, items)
    part_tree, corrections = state.redrawn
    return replace(analysis, part_tree=part_tree, corrections=corrections)


def with_items(
    state: MeshState, items: tuple[compute.Correction, ...], painted: NDArray[np.int64] | None = None
) -> StoredAnalysis:
    """Return the analysis of a mesh with other corrections; nothing is written.

    Parameters
    ----------
    painted : (F,) int64, optional
        The part each face is painted with, -1 elsewhere; as on the mesh if None.
    """
    analysis = state.analysis
    if not compute.needs_faces(items):
        return replace(analysis, corrections=compute.undivided(analysis.part_tree, items))
    painted = state.painted if painted is None else painted
    part_tree, corrections = compute.redraw(analysis.part_tree, items, painted, state.faces.relief, state.faces.graph)
    return replace(analysis, part_tree=part_tree, corrections=corrections)


def exact_labels(state: MeshState, labels: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the labels (F,) that a mesh shows with each face in the part that has the greater half of it.

    What else than an analysis has put there stays.
    """
    if state.match is not None:
        return compute.exact_labels(labels, state.analysis.part_tree, state.faces.graph)
    analysis = corrected(state)
    shown, exact = (
        compute.label_branches(tree, level=state.level, mode=state.mode, corrections=analysis.corrections)
        for tree in (analysis.part_tree, analysis.part_tree.exact)
    )
    return np.where(labels == shown.of_faces(analysis.part_tree), exact.of_faces(analysis.part_tree), labels)


def crossings(state: MeshState, source: BorderSource) -> tuple[compute.EdgeProfile, compute.Crossings]:
    """Return where the borders of the parts that a mesh shows cross its edges, and the arcs these refer to."""
    whole, analysis = state.analysis.part_tree, corrected(state)
    level, mode = state.level, state.mode
    corrections = analysis.corrections or compute.Corrections()
    labels = compute.label_branches(analysis.part_tree, level=level, mode=mode, corrections=corrections)
    drawn: tuple[compute.Drawn, ...] = ()
    if compute.needs_faces(corrections.items):
        relief = state.faces.relief
        try:
            drawn = compute.drawn_borders(whole, corrections, labels.resting, relief)
        except LookupError as error:
            # A level that a correction says it was made at has not the part it changes.
            raise Refusal(DAMAGED) from error
    cuts = whole.cut_arcs(level, mode, corrections.branch_levels)
    joined = compute.joined_parts(corrections, labels.resting)
    return compute.corrected_crossings(source.profile, whole, cuts, drawn, joined)


def peak_within(state: MeshState, item: compute.Correction, faces: NDArray[np.bool_]) -> float:
    """Return how far some faces (F,) rise above the border of a part, as a fraction of the field's range.

    Raises
    ------
    Refusal
        If the part has no border along the field.
    """
    hill, value_range = _hill(state, item), state.analysis.part_tree.hierarchy.value_range
    return hill.upward * (state.faces.relief.peak(hill, faces) - hill.border) / value_range


def refuse_without_border(state: MeshState, item: compute.Correction) -> None:
    """Raise a Refusal if the part of a correction does not end along the field."""
    _hill(state, item)


def refuse_uncorrectable(state: MeshState) -> None:
    """Raise a Refusal if the parts that a mesh shows are not its own."""
    if state.match is not None:
        raise Refusal(REGISTERED)


def free_part(state: MeshState) -> int:
    """Return a number for a part of one's own."""
    first = compute.first_own_part(state.analysis.part_tree.trees[0])
    taken = max((number for item in state.corrections for number in (item.part, item.other)), default=0)
    if taken >= first + MOST_OWN_PARTS - 1:
        raise Refusal("There are too many corrections; remove some first.")
    return max(first, taken + 1)


def _hill(state: MeshState, item: compute.Correction) -> compute.Hill:
    part_tree = state.analysis.part_tree
    try:
        return compute.hill_of(part_tree, state.corrections, item)
    except LookupError:
        raise Refusal("This part has no border along the field; assign faces to it instead.") from None
