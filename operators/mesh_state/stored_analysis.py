"""The analysis of a mesh as it is stored: trees and tables as plain numbers, what belongs to faces as attributes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ... import compute
from ..mesh_data.mesh_arrays import read_edges, read_own_floats, read_own_integers, write_attribute
from ..messages.user_errors import Refusal
from .schema import (
    ARCS,
    BRANCHES,
    CLOSING_HEIGHTS,
    CUT,
    DAMAGED,
    EDGE_HEIGHTS,
    HEIGHT,
    HIERARCHY,
    INSIDE_EDGES,
    PIECES_OF_TREE,
    TREE,
)
from .serialization import UNREADABLE, packed, packed_array, unpacked, unpacked_array
from .validation import is_sound, lie_within


@dataclass(frozen=True, eq=False)
class StoredAnalysis:
    """All that levels are read from.

    Attributes
    ----------
    hierarchy : Hierarchy
        Without the pairs that are noise.
    branches : tuple of Branches
        One for each tree.
    shells : str
        What was done with loose parts, one of ``compute.SHELLS``.
    corrections : Corrections, optional
        What was changed by hand; it refers to these branches.
    """

    hierarchy: compute.Hierarchy
    branches: tuple[compute.Branches, ...]
    shells: str
    corrections: compute.Corrections | None = None


@dataclass(frozen=True, eq=False)
class BorderSource:
    """What the borders of every level are cut from.

    Attributes
    ----------
    profile : EdgeProfile
        Of the edges of the mesh.
    vertex_heights : (V,) float64
    closing_heights : tuple of (A,) float64
        For each tree, the value of the field at which each arc closes.
    """

    profile: compute.EdgeProfile
    vertex_heights: np.ndarray
    closing_heights: tuple[np.ndarray, ...]


def packed_analysis(analysis: StoredAnalysis) -> dict[str, Any]:
    """Return an analysis as groups of the state."""
    hierarchy = analysis.hierarchy
    return {
        HIERARCHY: packed(hierarchy, _features(hierarchy)),
        **{TREE.format(i): packed(tree) for i, tree in enumerate(hierarchy.trees)},
        **packed_branches(analysis.branches),
    }


def packed_branches(branches: tuple[compute.Branches, ...]) -> dict[str, Any]:
    """Return the tables of branches as groups."""
    return {PIECES_OF_TREE.format(i): packed(pieces) for i, pieces in enumerate(branches)}


def packed_source(source: BorderSource) -> dict[str, Any]:
    """Return what goes into the state of the source of borders, beside its attributes."""
    heights = enumerate(source.closing_heights)
    closing = {CLOSING_HEIGHTS.format(i): packed_array(heights_of_tree) for i, heights_of_tree in heights}
    return {INSIDE_EDGES: source.profile.heights[:, 1:-1].shape[1], **closing}


def write_branches(mesh: bpy.types.Mesh, branches: tuple[compute.Branches, ...]) -> None:
    """Write the branch of each face, for each tree."""
    for attribute, pieces in zip(BRANCHES, branches, strict=False):
        write_attribute(mesh, attribute, pieces.of_face)


def write_source(mesh: bpy.types.Mesh, source: BorderSource) -> None:
    """Write the attributes that borders are cut from."""
    for attribute, arc in zip(ARCS, source.profile.arcs, strict=False):
        write_attribute(mesh, attribute, arc)
    write_attribute(mesh, HEIGHT, np.float32(source.vertex_heights))
    inside = np.nan_to_num(source.profile.heights[:, 1:-1])
    write_attribute(mesh, EDGE_HEIGHTS, np.float32(np.pad(inside, ((0, 0), (0, 2 - inside.shape[1])))))


def unpacked_analysis(mesh: bpy.types.Mesh, group: Any, shells: str) -> StoredAnalysis:
    """Return the analysis in a state; raises a Refusal if it is damaged."""
    try:
        trees = tuple(
            compute.ArcTree(**unpacked(group[TREE.format(i)], compute.ArcTree)) for i in range(_n_trees(group))
        )
        hierarchy = compute.Hierarchy(**unpacked(group[HIERARCHY], compute.Hierarchy), trees=trees)
        of_faces = [read_own_integers(mesh, attribute) for attribute, _ in zip(BRANCHES, trees, strict=False)]
        branches = unpacked_branches(group, of_faces)
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if not is_sound(hierarchy, branches):
        raise Refusal(DAMAGED)
    return StoredAnalysis(hierarchy, branches, shells)


def unpacked_branches(group: Any, of_faces: list[np.ndarray]) -> tuple[compute.Branches, ...]:
    """Return the branches in a group, with those of the faces for each tree."""
    return tuple(
        compute.Branches(of_face=of_face, **unpacked(group[PIECES_OF_TREE.format(i)], compute.Branches))
        for i, of_face in enumerate(of_faces)
    )


def unpacked_source(mesh: bpy.types.Mesh, group: Any, closing: tuple[np.ndarray, ...]) -> BorderSource:
    """Return what borders are cut from; raises a Refusal if it is damaged, or gone since the borders were cut."""
    try:
        n_inside = min(2, max(0, int(group[INSIDE_EDGES])))
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if ARCS[0].name not in mesh.attributes:
        raise Refusal(CUT)
    edges, heights = read_edges(mesh), vertex_heights(mesh)
    inside = read_own_floats(mesh, EDGE_HEIGHTS, 2).reshape(-1, 2)[:, :n_inside].astype(np.float64)
    along = np.column_stack([heights[edges[:, 0]], inside, heights[edges[:, 1]]])
    arcs = tuple(read_own_integers(mesh, attribute) for attribute, _ in zip(ARCS, closing, strict=False))
    if not all(lie_within(arc, -1, len(values)) for arc, values in zip(arcs, closing, strict=True)):
        raise Refusal(DAMAGED)
    along[(arcs[0][edges] < 0).any(axis=1)] = np.nan
    return BorderSource(compute.EdgeProfile(edges, along, arcs), heights, closing)


def unpacked_closing_heights(group: Any) -> tuple[np.ndarray, ...]:
    """Return for each tree the (A,) values of the field at which arcs close; raises a Refusal if they are damaged."""
    try:
        trees = range(_n_trees(group))
        heights = tuple(unpacked_array(group[CLOSING_HEIGHTS.format(i)], "float64") for i in trees)
        saddles = [unpacked_array(group[TREE.format(i)]["saddle"], "int64") for i in trees]
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    # Only a root and whole shells close nowhere.
    if not all(
        values.shape == saddle.shape and np.isfinite(values[saddle >= 0]).all()
        for values, saddle in zip(heights, saddles, strict=True)
    ):
        raise Refusal(DAMAGED)
    return heights


def has_trees(group: Any, hierarchy: compute.Hierarchy) -> bool:
    """Whether a state has the parts of a hierarchy, under the same numbers."""
    try:
        return all(
            np.array_equal(unpacked_array(group[TREE.format(i)][column], "int64"), getattr(tree, column))
            for i, tree in enumerate(hierarchy.trees)
            for column in ("part", "extremum")
        )
    except UNREADABLE:
        return False


def vertex_heights(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the (V,) values of the field on the vertices."""
    return read_own_floats(mesh, HEIGHT).astype(np.float64)


def _n_trees(group: Any) -> int:
    return 2 if TREE.format(1) in group else 1


def _features(hierarchy: compute.Hierarchy) -> slice:
    """Return where the pairs that are no noise stand."""
    return slice(len(hierarchy.pairs) - (hierarchy.n_levels - 1), None)
