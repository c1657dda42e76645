"""Whether all indices of a stored analysis lead somewhere, so that nothing read from a file can do harm."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import compute


def is_sound(part_tree: compute.PartTree) -> bool:
    """Whether trees, measures and branches fit each other."""
    hierarchy, branches = part_tree.hierarchy, part_tree.branches
    n_features = hierarchy.n_levels - 1
    if len({pieces.arc.size for pieces in branches}) != 1 or hierarchy.pairs.ndim != 2:
        return False
    columns = (hierarchy.pairs[:, :1].ravel(), hierarchy.persistence, hierarchy.is_maximum)
    return all(column.shape == (n_features,) for column in columns) and all(
        _is_sound_tree(tree, n_features)
        and _are_sound_measures(measures, len(tree.parent))
        and are_sound_branches(pieces, len(tree.parent))
        for tree, measures, pieces in zip(hierarchy.trees, part_tree.measures, branches, strict=True)
    )


def _is_sound_tree(tree: compute.ArcTree, n_features: int) -> bool:
    n_arcs = tree.parent.size
    columns = (
        *(tree.parent, tree.part, tree.extremum, tree.saddle, tree.closing, tree.joint_part, tree.joint_closing),
        *(tree.twin, tree.neck, tree.neck_closing),
    )
    if not all(column.shape == (n_arcs,) for column in columns):
        return False
    is_later = (tree.parent > np.arange(n_arcs)) | (tree.parent == -1)
    return (
        tree.n_features == n_features
        and 0 <= tree.n_roots <= 2 * n_arcs
        and bool(is_later.all())
        and lie_within(tree.parent, -1, n_arcs)
        and lie_within(tree.saddle, compute.NO_SADDLE, np.inf)
        and lie_within(tree.closing, compute.ALWAYS, compute.NEVER + 1)
        and lie_within(tree.part, 1, 2 * (n_features + n_arcs) + 1)
        and bool(((tree.joint_part >= 1) & (tree.joint_part <= tree.part)).all())
        and bool(((tree.joint_closing >= compute.ALWAYS) & (tree.joint_closing <= tree.closing)).all())
        and _are_sound_necks(tree)
        and _are_sound_shells(tree)
    )


def _are_sound_necks(tree: compute.ArcTree) -> bool:
    """Whether necks have places of their own among all, and lie where no pair ends; twins are arcs."""
    neck, n_arcs = tree.neck[tree.is_neck], len(tree.parent)
    return (
        lie_within(tree.twin, 0, n_arcs)
        and 0 <= tree.n_necks <= 2 * n_arcs
        and lie_within(neck, 0, tree.n_necks)
        and len(np.unique(neck)) == len(neck)
        and lie_within(tree.neck_closing, compute.ALWAYS, compute.NEVER + 1)
        and bool((tree.has_saddle & (tree.closing == compute.NEVER))[tree.is_neck].all())
    )


def _are_sound_measures(measures: compute.ArcMeasures, n_arcs: int) -> bool:
    columns = (measures.height, measures.closing_length, measures.longest, measures.roundness)
    if not all(column.shape == (n_arcs,) and lie_within(column, 0, np.inf) for column in columns):
        return False
    # The closing level set is one of those among which the longest was found.
    return bool((measures.longest >= measures.closing_length).all())


def _are_sound_shells(tree: compute.ArcTree) -> bool:
    """Whether whole shells stand under the root, with numbers of their own that follow those of the roots."""
    is_shell, root = tree.is_shell, len(tree.parent) - 1
    numbers = tree.n_roots + 1 + np.arange(-int(is_shell.sum()), 0)
    return (
        np.array_equal(tree.part[is_shell], numbers)
        and bool((tree.parent[is_shell] == root).all())
        and not np.isin(tree.part[~is_shell], numbers).any()
    )


def are_sound_branches(branches: compute.Branches, n_arcs: int) -> bool:
    """Whether the tables of branches fit each other and a tree."""
    n_branches = branches.arc.size
    return (
        branches.area.shape == branches.n_faces.shape == branches.arc.shape == branches.shown.shape == (n_branches,)
        and branches.borders.shape == (branches.border_length.size, 2)
        and branches.border_length.ndim == 1
        and lie_within(branches.n_faces, 0, len(branches.of_face) + 1)
        and lie_within(branches.area, 0, np.inf)
        and lie_within(branches.arc, 0, n_arcs)
        and lie_within(branches.shown, 0, n_arcs)
        and lie_within(branches.borders, 0, n_branches)
        and lie_within(branches.of_face, 0, n_branches)
    )


def lie_within(indices: NDArray[np.integer[Any]] | NDArray[np.floating[Any]], start: float, stop: float) -> bool:
    """Whether all indices are at least ``start`` and below ``stop``."""
    return indices.size == 0 or bool(indices.min() >= start and indices.max() < stop)
