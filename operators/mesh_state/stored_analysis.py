"""The analysis of a mesh as it is stored: trees and tables as plain numbers, what belongs to faces as attributes."""

from __future__ import annotations

from itertools import zip_longest
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.attribute_types import Values
from ...tasks.mesh_analysis import BorderSource, StoredAnalysis
from ...tasks.mesh_shape import NO_STRETCH, Stretch
from ...tasks.refusals import Refusal
from ..mesh_data.mesh_arrays import OwnAttribute, read_edges, read_own_floats, read_own_integers
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
    PAIRED_EDGE_HEIGHTS,
    PIECES_OF_TREE,
    PLACES,
    STRETCH,
    TREE,
)
from .serialization import UNREADABLE, packed, packed_array, unpacked, unpacked_array
from .validation import is_sound, lie_within


def packed_tree(part_tree: compute.PartTree) -> dict[str, Any]:
    """Return the tables of a part tree as groups of the state; the measures of arcs stand beside their tree."""
    hierarchy = part_tree.hierarchy
    arcs = enumerate(zip(hierarchy.trees, part_tree.measures, strict=True))
    closing = enumerate(part_tree.closing_heights)
    return {
        HIERARCHY: packed(hierarchy, _features(hierarchy)),
        **{TREE.format(i): packed(tree) | packed(measures) for i, (tree, measures) in arcs},
        **{CLOSING_HEIGHTS.format(i): packed_array(heights) for i, heights in closing},
        **packed_branches(part_tree.branches),
    }


def packed_stretch(stretch: Stretch) -> dict[str, Any]:
    """Return a stretch as a value of the state, nothing if it is none."""
    return {} if stretch.is_none else {STRETCH: stretch.matrix.ravel().tolist()}


def unpacked_stretch(values: Any) -> Stretch:
    """Return the stretch that a mesh was analyzed with; raises a Refusal if it is damaged."""
    if values is None:
        return NO_STRETCH
    if getattr(values, "typecode", "") not in tuple("df") or len(values) != 9:
        raise Refusal(DAMAGED)
    matrix = np.array(values, dtype=np.float64).reshape(3, 3)
    if not (np.isfinite(matrix).all() and np.isclose(abs(np.linalg.det(matrix)), 1)):
        raise Refusal(DAMAGED)
    return Stretch(matrix)


def packed_branches(branches: tuple[compute.Branches, ...]) -> dict[str, Any]:
    """Return the tables of branches as groups."""
    return {PIECES_OF_TREE.format(i): packed(pieces) for i, pieces in enumerate(branches)}


def packed_source(source: BorderSource) -> dict[str, Any]:
    """Return the values of the state that belong to the attributes of a source of borders."""
    return {INSIDE_EDGES: source.profile.heights[:, 1:-1].shape[1]}


def branch_attributes(branches: tuple[compute.Branches, ...]) -> dict[OwnAttribute, Values | None]:
    """Return the branch of each face, for each tree that there can be; None for one that is not there."""
    of_faces = [pieces.of_face for pieces in branches]
    return dict(zip_longest(BRANCHES, of_faces))


def source_attributes(source: BorderSource) -> dict[OwnAttribute, Values | None]:
    """Return the attributes that borders are cut from; None for those of a tree that is not there."""
    inside = np.nan_to_num(source.profile.heights[:, 1:-1])
    return {
        **dict(zip_longest(ARCS, source.profile.arcs)),
        HEIGHT: source.vertex_heights.astype(np.float32),
        EDGE_HEIGHTS: np.pad(inside, ((0, 0), (0, 3 - inside.shape[1]))).astype(np.float32),
        PAIRED_EDGE_HEIGHTS: None,
    }


def place_attribute(place_of_vertex: NDArray[np.int64]) -> dict[OwnAttribute, Values | None]:
    """Return the attribute of the vertices (V,) that stand for others at their place; None if there are no such."""
    is_alone = np.array_equal(place_of_vertex, np.arange(len(place_of_vertex)))
    return {PLACES: None if is_alone else place_of_vertex.astype(np.int32)}


def places_of_vertices(mesh: bpy.types.Mesh) -> NDArray[np.int32] | None:
    """Return the (V,) vertex that stands for each along seams; None if each stands for itself."""
    if not PLACES.is_on(mesh):
        return None
    places = read_own_integers(mesh, PLACES)
    if not lie_within(places, 0, len(places)):
        raise Refusal(DAMAGED)
    return places


def unpacked_analysis(mesh: bpy.types.Mesh, group: Any, shells: str, stretch: Stretch) -> StoredAnalysis:
    """Return the analysis in a state; raises a Refusal if it is damaged."""
    try:
        part_tree = _unpacked_tree(mesh, group)
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if not is_sound(part_tree):
        raise Refusal(DAMAGED)
    return StoredAnalysis(part_tree, shells, stretch)


def unpacked_branches(group: Any, of_faces: list[NDArray[np.int32]]) -> tuple[compute.Branches, ...]:
    """Return the branches in a group, with those of the faces for each tree."""
    return tuple(
        compute.Branches(of_face=of_face, **unpacked(_with_shown(group[PIECES_OF_TREE.format(i)]), compute.Branches))
        for i, of_face in enumerate(of_faces)
    )


def _with_shown(pieces: Any) -> Any:
    """Return stored branches with the arcs that they are shown in; in 0.1.0 these were their own."""
    return pieces if "shown" in pieces else {**pieces, "shown": pieces["arc"]}


def unpacked_source(mesh: bpy.types.Mesh, group: Any, part_tree: compute.PartTree) -> BorderSource:
    """Return what the borders of a part tree are cut from; raises a Refusal if it is damaged, or they were cut."""
    try:
        n_inside = min(2, max(0, int(group[INSIDE_EDGES])))
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if ARCS[0].name not in mesh.attributes:
        raise Refusal(CUT)
    edges, heights = read_edges(mesh), vertex_heights(mesh)
    inside = _inside_heights(mesh)[:, :n_inside].astype(np.float64)
    along = np.column_stack([heights[edges[:, 0]], inside, heights[edges[:, 1]]])
    arcs = tuple(read_own_integers(mesh, attribute) for attribute, _ in zip(ARCS, part_tree.trees, strict=False))
    if not all(lie_within(arc, -1, len(values)) for arc, values in zip(arcs, part_tree.closing_heights, strict=True)):
        raise Refusal(DAMAGED)
    along[(arcs[0][edges] < 0).any(axis=1)] = np.nan
    return BorderSource(compute.EdgeProfile(edges, along, arcs), heights)


def _inside_heights(mesh: bpy.types.Mesh) -> NDArray[np.float32]:
    """Return the (E, 2 or 3) values on the edges, of which those inside come first."""
    if PAIRED_EDGE_HEIGHTS.is_on(mesh) and not EDGE_HEIGHTS.is_on(mesh):
        return read_own_floats(mesh, PAIRED_EDGE_HEIGHTS, 2).reshape(-1, 2)
    return read_own_floats(mesh, EDGE_HEIGHTS, 3).reshape(-1, 3)


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


def vertex_heights(mesh: bpy.types.Mesh) -> NDArray[np.float64]:
    """Return the (V,) values of the field on the vertices."""
    return read_own_floats(mesh, HEIGHT).astype(np.float64)


def _unpacked_tree(mesh: bpy.types.Mesh, group: Any) -> compute.PartTree:
    n_trees = 2 if TREE.format(1) in group else 1
    tables = [group[TREE.format(i)] for i in range(n_trees)]
    trees = tuple(
        compute.ArcTree(**unpacked(_with_twins(table), compute.ArcTree, _without_necks(table))) for table in tables
    )
    return compute.PartTree(
        hierarchy=compute.Hierarchy(**unpacked(group[HIERARCHY], compute.Hierarchy), trees=trees),
        measures=tuple(
            compute.ArcMeasures(**unpacked({"widest": table["longest"], **table}, compute.ArcMeasures))
            for table in tables
        ),
        closing_heights=tuple(_unpacked_closing_heights(group, i, tree) for i, tree in enumerate(trees)),
        branches=unpacked_branches(group, [read_own_integers(mesh, attribute) for attribute in BRANCHES[:n_trees]]),
    )


def _with_twins(table: Any) -> Any:
    """Return a stored tree with what twins have in common; in 0.1.0 there were none."""
    own = {"joint_part": "part", "joint_closing": "closing"}
    return {**table, **{joint: table[name] for joint, name in own.items() if joint not in table}}


def _without_necks(table: Any) -> dict[str, Any]:
    """Return what is known of a stored tree in which no necks were looked for; nothing if they were."""
    return {} if "neck" in table else compute.without_necks(len(unpacked_array(table["part"], "int64")))


def _unpacked_closing_heights(group: Any, number: int, tree: compute.ArcTree) -> NDArray[np.float64]:
    """Return the (A,) values of the field at which arcs close; only a root and whole shells close nowhere."""
    heights = unpacked_array(group[CLOSING_HEIGHTS.format(number)], "float64")
    if heights.shape != tree.saddle.shape or not np.isfinite(heights[tree.saddle >= 0]).all():
        raise ValueError("closing heights")
    return heights


def _features(hierarchy: compute.Hierarchy) -> slice:
    """Return where the pairs that are no noise stand."""
    return slice(len(hierarchy.pairs) - (hierarchy.n_levels - 1), None)
