"""What is stored on a mesh, so that any level is one look-up: also after a load, an undo or on a copy.

The trees and tables are plain numbers and texts in the mesh's custom properties; the branch of each face is an
attribute.
Nothing is trusted when it is read back: a file may come from anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ... import compute
from ..mesh_data.mesh_arrays import (
    OwnAttribute,
    fingerprint,
    read_edges,
    read_own_floats,
    read_own_integers,
    remove_own_attributes,
    write_attribute,
)
from ..messages.user_errors import Refusal
from . import corrections
from .serialization import UNREADABLE, packed, packed_array, unpacked, unpacked_array
from .validation import is_sound, lie_within

STATE = "eigenparts_state"
# 2: with corrections by hand, which a state of version 1 has none of.
SCHEMA = 2
# One attribute for each merge tree; the second is there only where minima are features too.
BRANCHES = (
    OwnAttribute("eigenparts_branch", "INT", "FACE"),
    OwnAttribute("eigenparts_branch_minima", "INT", "FACE"),
)

# What borders are cut from: the arc of each vertex in each tree, and the field on vertices and inside edges. The names
# begin with a dot, so that Blender leaves them out of its lists.
ARCS = (
    OwnAttribute(".eigenparts_arc", "INT", "POINT"),
    OwnAttribute(".eigenparts_arc_minima", "INT", "POINT"),
)
HEIGHT = OwnAttribute(".eigenparts_height", "FLOAT", "POINT")
EDGE_HEIGHTS = OwnAttribute(".eigenparts_edge_heights", "FLOAT2", "EDGE", "vector")
ATTRIBUTES = (*BRANCHES, *ARCS, HEIGHT, EDGE_HEIGHTS, *corrections.ATTRIBUTES)
# What outlives a new analysis: choices of the user, and what is known of the parts as long as they are the same.
CHOICES = ("mode", "outputs", "softness")
REGISTRATION = "registration"  # only while the mesh shows the parts of another
OF_PARTS = ("part_numbers", "part_names", "part_colours", REGISTRATION)
# What can be done with loose parts; the first where nothing is said of it.
SHELLS = ("bridged", "largest", "separate")
# More than any mesh has, so that a damaged number makes no table that fills the memory.
MOST_LABELS = 1 << 22
LONGEST_DESCRIPTION = 200

NEWER = "This mesh was analyzed by a newer version of Eigenparts; update the extension or analyze the mesh again."
CUT = "The borders of this mesh were cut already; analyze it again to cut it at another level."
CHANGED = "The mesh was changed after it was analyzed; analyze it again."
DAMAGED = "The analysis stored on this mesh is damaged; analyze it again."
ABSENT = "Analyze the mesh first."
LOST = "The parts that some corrections by hand belong to are not found any more; these corrections were removed."


@dataclass(frozen=True, eq=False)
class StoredAnalysis:
    """All that levels are read from.

    Attributes
    ----------
    part_tree : PartTree
        Without the pairs that are noise.
    shells : str
        What was done with loose parts, one of ``SHELLS``.
    corrections : Corrections, optional
        What was changed by hand; it refers to the branches of this tree.
    """

    part_tree: compute.PartTree
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
    """

    profile: compute.EdgeProfile
    vertex_heights: np.ndarray


@dataclass(frozen=True)
class Summary:
    """What the user wants to see of the state.

    Attributes
    ----------
    description : str
        Field and order, in words.
    level, n_levels : int
    parts : tuple of (id, area, faces)
        The body first, if it has faces; the area as a fraction of the whole.
    """

    description: str
    level: int
    n_levels: int
    parts: tuple[tuple[int, float, int], ...]


def is_analyzed(mesh: bpy.types.Mesh) -> bool:
    """Whether the mesh carries an analysis of any version."""
    return STATE in mesh


def is_analyzed_for(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether the active mesh carries an analysis; if not, the tooltip says what to do."""
    if not is_analyzed(context.object.data):
        operator.poll_message_set(ABSENT)
    return is_analyzed(context.object.data)


def store(mesh: bpy.types.Mesh, analysis: StoredAnalysis, source: BorderSource, description: str) -> tuple[str, ...]:
    """Put an analysis on the mesh it was made from, in place of an earlier one, and return warnings for the user."""
    part_tree = analysis.part_tree
    kept = _kept(mesh, part_tree.hierarchy)
    items, warnings = _kept_corrections(mesh, analysis)
    corrections.drop_pieces(mesh, {})
    n_trees = len(part_tree.trees)
    remove_own_attributes(mesh, [own.name for own in BRANCHES[n_trees:] + ARCS[n_trees:]])
    _write_branches(mesh, part_tree.branches)
    mesh[STATE] = {
        "schema": SCHEMA,
        "fingerprint": fingerprint(mesh),
        "description": description,
        "shells": analysis.shells,
        **kept,
        corrections.CORRECTIONS: corrections.packed_items(items),
        **_packed_tree(part_tree),
        "n_inside_edge": _store_source(mesh, source),
    }
    return warnings


def store_branches(mesh: bpy.types.Mesh, branches: tuple[compute.Branches, ...]) -> None:
    """Put new faces of the arcs on a mesh whose faces were cut; its borders can be cut no more."""
    _write_branches(mesh, branches)
    for i, pieces in enumerate(branches):
        mesh[STATE][f"branches_{i}"] = packed(pieces)
    mesh[STATE]["fingerprint"] = fingerprint(mesh)
    corrections.drop_pieces(mesh, mesh[STATE])
    remove_own_attributes(mesh, [own.name for own in (*ARCS, EDGE_HEIGHTS)])


def load_source(mesh: bpy.types.Mesh) -> BorderSource:
    """Return what borders are cut from; raises a Refusal if it is not there."""
    closing = closing_heights(mesh)
    try:
        n_inside = min(2, max(0, int(_current(mesh)["n_inside_edge"])))
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if ARCS[0].name not in mesh.attributes:
        raise Refusal(CUT)
    edges, heights = read_edges(mesh), vertex_heights(mesh)
    inside = read_own_floats(mesh, EDGE_HEIGHTS, 2).reshape(-1, 2)[:, :n_inside].astype(np.float64)
    along = np.column_stack([heights[edges[:, 0]], inside, heights[edges[:, 1]]])
    arcs = tuple(read_own_integers(mesh, own) for own, _ in zip(ARCS, closing, strict=False))
    if not all(lie_within(arc, -1, len(heights)) for arc, heights in zip(arcs, closing, strict=True)):
        raise Refusal(DAMAGED)
    along[(arcs[0][edges] < 0).any(axis=1)] = np.nan
    return BorderSource(compute.EdgeProfile(edges, along, arcs), heights)


def vertex_heights(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the (V,) values of the field on the vertices."""
    return read_own_floats(mesh, HEIGHT).astype(np.float64)


def closing_heights(mesh: bpy.types.Mesh) -> tuple[np.ndarray, ...]:
    """Return for each tree the (A,) values of the field at which arcs close; raises a Refusal if they are not there."""
    state = _current(mesh)
    try:
        heights = tuple(
            unpacked_array(state[f"closing_heights_{i}"], "float64") for i in range(2 if "tree_1" in state else 1)
        )
        saddles = [unpacked_array(state[f"tree_{i}"]["saddle"], "int64") for i in range(len(heights))]
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    # Only a root and whole shells close nowhere.
    if not all(
        one.shape == saddle.shape and np.isfinite(one[saddle >= 0]).all()
        for one, saddle in zip(heights, saddles, strict=True)
    ):
        raise Refusal(DAMAGED)
    return heights


def face_areas(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the (F,) areas of the faces."""
    areas = np.empty(len(mesh.polygons), dtype=np.float32)
    mesh.polygons.foreach_get("area", areas)
    return areas.astype(np.float64)


def _write_branches(mesh: bpy.types.Mesh, branches: tuple[compute.Branches, ...]) -> None:
    for own, pieces in zip(BRANCHES, branches, strict=False):
        write_attribute(mesh, own, pieces.of_face)


def _packed_tree(part_tree: compute.PartTree) -> dict[str, Any]:
    """Return the tables of a part tree as groups of the state; the measures of arcs stand beside their tree."""
    hierarchy = part_tree.hierarchy
    arcs = zip(hierarchy.trees, part_tree.measures, strict=True)
    return {
        "hierarchy": packed(hierarchy, _features(hierarchy)),
        **{f"tree_{i}": packed(tree) | packed(measures) for i, (tree, measures) in enumerate(arcs)},
        **{f"branches_{i}": packed(branches) for i, branches in enumerate(part_tree.branches)},
        **{f"closing_heights_{i}": packed_array(heights) for i, heights in enumerate(part_tree.closing_heights)},
    }


def _store_source(mesh: bpy.types.Mesh, source: BorderSource) -> int:
    """Write attributes, and return how many points inside each edge they have."""
    for own, arc in zip(ARCS, source.profile.arcs, strict=False):
        write_attribute(mesh, own, arc)
    write_attribute(mesh, HEIGHT, np.float32(source.vertex_heights))
    inside = np.nan_to_num(source.profile.heights[:, 1:-1])
    n_inside = inside.shape[1]
    write_attribute(mesh, EDGE_HEIGHTS, np.float32(np.pad(inside, ((0, 0), (0, 2 - n_inside)))))
    return n_inside


def load(mesh: bpy.types.Mesh) -> StoredAnalysis:
    """Return the analysis that is stored on a mesh.

    Raises
    ------
    Refusal
        If there is none, or it is from a newer version, of another shape, or damaged.
    """
    state = _current(mesh)
    if state.get("fingerprint") != fingerprint(mesh):
        raise Refusal(CHANGED)
    return _sound_analysis(mesh, state)


def _sound_analysis(mesh: bpy.types.Mesh, state: Any) -> StoredAnalysis:
    try:
        analysis = _unpacked_analysis(mesh, state)
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if not is_sound(analysis.part_tree):
        raise Refusal(DAMAGED)
    return analysis


def remember_segmentation(mesh: bpy.types.Mesh, labels: compute.BranchLabels, mode: str) -> None:
    """Store which level the mesh shows, in which mode, and what parts it has."""
    mesh[STATE]["level"] = labels.level
    mesh[STATE]["mode"] = mode
    mesh[STATE]["parts"] = packed(labels.parts)


def mode_of(mesh: bpy.types.Mesh) -> str:
    """Return the mode the mesh was last divided in, the default one if it never was."""
    state = mesh.get(STATE)
    mode = state.get("mode") if hasattr(state, "to_dict") else None
    return mode if mode in compute.MODES else compute.MODES[0]


def shells_of(mesh: bpy.types.Mesh) -> str:
    """Return what was done with the loose parts of an analyzed mesh."""
    state = mesh.get(STATE)
    shells = state.get("shells") if hasattr(state, "to_dict") else None
    return shells if shells in SHELLS else SHELLS[0]


def summarize(mesh: bpy.types.Mesh) -> Summary:
    """Return what the panel shows of the state; raises a Refusal if it cannot be read."""
    state = _current(mesh)
    try:
        kinds = {"id": "int64", "area": "float64", "n_triangles": "int64"}
        parts = {name: unpacked_array(state["parts"][name], dtype) for name, dtype in kinds.items()}
        whole = parts["area"].sum()
        if not 0 < whole < np.inf or parts["area"].min() < 0:
            raise ValueError("area")
        share = parts["area"] / whole
        rows = tuple(zip(parts["id"].tolist(), share.tolist(), parts["n_triangles"].tolist(), strict=True))
        summary = Summary(state["description"], state["level"], state["hierarchy"]["n_levels"], rows)
    except UNREADABLE as error:
        raise Refusal(DAMAGED) from error
    if not _makes_sense(summary):
        raise Refusal(DAMAGED)
    return summary


def _makes_sense(summary: Summary) -> bool:
    return (
        isinstance(summary.description, str)
        and len(summary.description) <= LONGEST_DESCRIPTION
        and isinstance(summary.level, int)
        and isinstance(summary.n_levels, int)
        and 0 <= summary.level < summary.n_levels
        and all(0 <= part < MOST_LABELS and n_faces >= 0 for part, _, n_faces in summary.parts)
    )


def forget(mesh: bpy.types.Mesh) -> None:
    """Remove the analysis; the attributes stay."""
    if STATE in mesh:
        del mesh[STATE]


def _kept(mesh: bpy.types.Mesh, hierarchy: compute.Hierarchy) -> dict[str, Any]:
    """Return what of an earlier state goes on with a new analysis."""
    state = mesh.get(STATE)
    if not hasattr(state, "to_dict"):
        return {}
    names = CHOICES + (OF_PARTS if _has_trees(state, hierarchy) else ())
    return {
        name: state[name].to_dict() if hasattr(state[name], "to_dict") else state[name]
        for name in names
        if name in state
    }


def _kept_corrections(
    mesh: bpy.types.Mesh, analysis: StoredAnalysis
) -> tuple[tuple[compute.Correction, ...], tuple[str, ...]]:
    """Return the corrections of an earlier state with the numbers that their parts have now, and warnings."""
    items = corrections.read(mesh.get(STATE))
    if not items or _has_trees(mesh[STATE], analysis.part_tree.hierarchy):
        return items, ()
    try:
        old = _sound_analysis(mesh, _current(mesh))
    except Refusal:
        return (), (LOST,)
    kept = corrections.carry_over(mesh, items, old.part_tree, analysis.part_tree, face_areas(mesh))
    return kept, (LOST,) if len(kept) < len(items) else ()


def _has_trees(state: Any, hierarchy: compute.Hierarchy) -> bool:
    """Whether a state has the parts of a hierarchy, under the same numbers."""
    try:
        return all(
            np.array_equal(unpacked_array(state[f"tree_{i}"][column], "int64"), getattr(tree, column))
            for i, tree in enumerate(hierarchy.trees)
            for column in ("part", "extremum")
        )
    except UNREADABLE:
        return False


def _current(mesh: bpy.types.Mesh) -> Any:
    """Return the state's group if it is of a version that is known here."""
    state = mesh.get(STATE)
    if state is None:
        raise Refusal(ABSENT)
    if not hasattr(state, "to_dict") or not isinstance(state.get("schema"), int):
        raise Refusal(DAMAGED)
    if state["schema"] > SCHEMA:
        raise Refusal(NEWER)
    return state


def _features(hierarchy: compute.Hierarchy) -> slice:
    """Return where the pairs that are no noise stand."""
    return slice(len(hierarchy.pairs) - (hierarchy.n_levels - 1), None)


def _unpacked_analysis(mesh: bpy.types.Mesh, state: Any) -> StoredAnalysis:
    n_trees = 2 if "tree_1" in state else 1
    trees = [state[f"tree_{i}"] for i in range(n_trees)]
    part_tree = compute.PartTree(
        hierarchy=compute.Hierarchy(
            **unpacked(state["hierarchy"], compute.Hierarchy),
            trees=tuple(compute.ArcTree(**unpacked(tree, compute.ArcTree)) for tree in trees),
        ),
        measures=tuple(compute.ArcMeasures(**unpacked(tree, compute.ArcMeasures)) for tree in trees),
        closing_heights=closing_heights(mesh),
        branches=tuple(
            compute.Branches(
                of_face=read_own_integers(mesh, BRANCHES[i]), **unpacked(state[f"branches_{i}"], compute.Branches)
            )
            for i in range(n_trees)
        ),
    )
    return StoredAnalysis(part_tree, shells_of(mesh))
