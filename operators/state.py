"""What is stored on a mesh, so that any level is one look-up: also after a load, an undo or on a copy.

The trees and tables are plain numbers and texts in the mesh's custom properties; the branch of each face is an
attribute.
Nothing is trusted when it is read back: a file may come from anywhere.
"""

from dataclasses import dataclass, fields
from typing import Any

import bpy
import numpy as np

from . import engine
from .exchange import OwnAttribute, fingerprint, read_own_integers, remove_own_attributes, write_attribute
from .refusals import Refusal

STATE = "eigenparts_state"
SCHEMA = 1
# One attribute for each merge tree; the second is there only where minima are features too.
BRANCHES = (
    OwnAttribute("eigenparts_branch", "INT", "FACE"),
    OwnAttribute("eigenparts_branch_minima", "INT", "FACE"),
)

# How levels are read, the default first.
MODES = ("nested", "features")

NEWER = "This mesh was analyzed by a newer version of Eigenparts; update the extension or analyze the mesh again."
CHANGED = "The mesh was changed after it was analyzed; analyze it again."
DAMAGED = "The analysis stored on this mesh is damaged; analyze it again."
ABSENT = "Analyze the mesh first."

_INT32 = np.iinfo(np.int32)
_DTYPES = ("int64", "float64", "bool")


@dataclass(frozen=True, eq=False)
class StoredAnalysis:
    """All that levels are read from.

    Attributes
    ----------
    hierarchy : Hierarchy
        Without the pairs that are noise.
    branches : tuple of Branches
        One for each tree.
    """

    hierarchy: "engine.Hierarchy"
    branches: tuple["engine.Branches", ...]


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


def store(mesh: bpy.types.Mesh, analysis: StoredAnalysis, description: str) -> None:
    """Put an analysis on the mesh it was made from, in place of an earlier one."""
    hierarchy = analysis.hierarchy
    mode = mode_of(mesh)
    remove_own_attributes(mesh, [own.name for own in BRANCHES[len(analysis.branches) :]])
    for own, branches in zip(BRANCHES, analysis.branches, strict=False):
        write_attribute(mesh, own, branches.of_face)
    mesh[STATE] = {
        "schema": SCHEMA,
        "fingerprint": fingerprint(mesh),
        "description": description,
        "mode": mode,
        "hierarchy": _packed(hierarchy, _features(hierarchy)),
        **{f"tree_{i}": _packed(tree) for i, tree in enumerate(hierarchy.trees)},
        **{f"branches_{i}": _packed(branches) for i, branches in enumerate(analysis.branches)},
    }


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
    try:
        analysis = _unpacked_analysis(mesh, state)
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise Refusal(DAMAGED) from error
    if not _is_sound(analysis):
        raise Refusal(DAMAGED)
    return analysis


def remember_segmentation(mesh: bpy.types.Mesh, labels: "engine.BranchLabels", mode: str) -> None:
    """Store which level the mesh shows, in which mode, and what parts it has."""
    mesh[STATE]["level"] = labels.level
    mesh[STATE]["mode"] = mode
    mesh[STATE]["parts"] = _packed(labels.parts)


def mode_of(mesh: bpy.types.Mesh) -> str:
    """Return the mode the mesh was last divided in, the default one if it never was."""
    state = mesh.get(STATE)
    mode = state.get("mode") if hasattr(state, "keys") else None
    return mode if mode in MODES else MODES[0]


def summarize(mesh: bpy.types.Mesh) -> Summary:
    """Return what the panel shows of the state; raises a Refusal if it cannot be read."""
    state = _current(mesh)
    try:
        parts = _unpacked(state["parts"])
        share = parts["area"] / parts["area"].sum()
        rows = tuple(zip(parts["id"].tolist(), share.tolist(), parts["n_triangles"].tolist(), strict=True))
        return Summary(str(state["description"]), int(state["level"]), int(state["hierarchy"]["n_levels"]), rows)
    except (KeyError, TypeError, ValueError) as error:
        raise Refusal(DAMAGED) from error


def forget(mesh: bpy.types.Mesh) -> None:
    """Remove the analysis; the attributes stay."""
    if STATE in mesh:
        del mesh[STATE]


def _current(mesh: bpy.types.Mesh) -> Any:
    """Return the state's group if it is of a version that is known here."""
    state = mesh.get(STATE)
    if state is None:
        raise Refusal(ABSENT)
    if not hasattr(state, "keys") or not isinstance(state.get("schema"), int):
        raise Refusal(DAMAGED)
    if state["schema"] > SCHEMA:
        raise Refusal(NEWER)
    return state


def _features(hierarchy: "engine.Hierarchy") -> slice:
    """Return where the pairs that are no noise stand."""
    return slice(len(hierarchy.pairs) - (hierarchy.n_levels - 1), None)


def _packed(record: Any, rows: slice = slice(None)) -> dict[str, Any]:
    """Return numbers of a record, and arrays as lists with their shapes; what belongs to each face is an attribute."""
    values = {field.name: getattr(record, field.name) for field in fields(record) if field.name != "of_face"}
    arrays = {name: _packed_array(value[rows]) for name, value in values.items() if isinstance(value, np.ndarray)}
    return arrays | {name: value for name, value in values.items() if isinstance(value, bool | int | float)}


def _packed_array(array: np.ndarray) -> dict[str, Any]:
    values = array
    if array.dtype.kind in "iub":
        # Custom properties hold 32 bits; beyond that there is only the "never" of a tree's root, and it stays so.
        values = np.clip(array, _INT32.min, _INT32.max)
    dtype = {"i": "int64", "u": "int64", "f": "float64", "b": "bool"}[array.dtype.kind]
    packed = {"dtype": dtype, "shape": list(array.shape)}
    return packed | ({"values": values.ravel().tolist()} if array.size else {})


def _unpacked(group: Any) -> dict[str, Any]:
    """Return the fields of a packed record."""
    return {name: _unpacked_array(group[name]) if hasattr(group[name], "keys") else group[name] for name in group}


def _unpacked_array(group: Any) -> np.ndarray:
    if group["dtype"] not in _DTYPES:
        raise ValueError(group["dtype"])
    values = np.array(group.get("values", []), dtype=group["dtype"])
    return values.reshape([int(size) for size in group["shape"]])


def _unpacked_analysis(mesh: bpy.types.Mesh, state: Any) -> StoredAnalysis:
    n_trees = 2 if "tree_1" in state else 1
    trees = tuple(engine.ArcTree(**_unpacked(state[f"tree_{i}"])) for i in range(n_trees))
    hierarchy = engine.Hierarchy(**_unpacked(state["hierarchy"]), trees=trees)
    branches = tuple(
        engine.Branches(of_face=read_own_integers(mesh, BRANCHES[i]), **_unpacked(state[f"branches_{i}"]))
        for i in range(n_trees)
    )
    return StoredAnalysis(hierarchy, branches)


def _is_sound(analysis: StoredAnalysis) -> bool:
    """Whether all indices lead somewhere, so that nothing read from a file can do harm."""
    hierarchy = analysis.hierarchy
    n_features = hierarchy.n_levels - 1
    if len({len(branches.arc) for branches in analysis.branches}) != 1:
        return False
    return len(hierarchy.pairs) == len(hierarchy.persistence) == len(hierarchy.is_maximum) == n_features and all(
        _is_sound_tree(tree, n_features) and _are_sound_branches(branches, len(tree.parent))
        for tree, branches in zip(hierarchy.trees, analysis.branches, strict=True)
    )


def _is_sound_tree(tree: "engine.ArcTree", n_features: int) -> bool:
    n_arcs = len(tree.parent)
    columns = (tree.part, tree.extremum, tree.saddle, tree.closing)
    is_later = (tree.parent > np.arange(n_arcs)) | (tree.parent == -1)
    return (
        all(column.shape == (n_arcs,) for column in columns)
        and bool(is_later.all())
        and _lie_within(tree.parent, -1, n_arcs)
        and _lie_within(tree.part, 1, 2 * n_features + n_arcs + 1)
    )


def _are_sound_branches(branches: "engine.Branches", n_arcs: int) -> bool:
    n_branches = len(branches.arc)
    return (
        branches.area.shape == branches.n_faces.shape == branches.arc.shape == (n_branches,)
        and branches.borders.shape == (len(branches.border_length), 2)
        and _lie_within(branches.arc, 0, n_arcs)
        and _lie_within(branches.borders, 0, n_branches)
        and _lie_within(branches.of_face, 0, n_branches)
    )


def _lie_within(indices: np.ndarray, start: int, stop: int) -> bool:
    return indices.size == 0 or bool(indices.min() >= start and indices.max() < stop)
