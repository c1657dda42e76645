"""Matching of parts: the subtrees of the merge tree that cover the same points as the parts of a reference."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...choices import FEATURES
from ...segmentation.faces.exact_labels import exact_labels
from ...segmentation.hierarchy.arc_tree import ArcTree
from ...segmentation.hierarchy.levels import Hierarchy
from ...segmentation.parts.part_labels import BODY, Parts
from ...surface.mesh import Bools, Floats, Ints
from ...surface.ties import evened
from .transferred_labels import Divisible, GivenParts, given_parts

# A part and its partner share at least this much of what they cover together.
LEAST_OVERLAP = 0.3


@dataclass(frozen=True, eq=False)
class ReferenceParts:
    """The parts of a reference, to be found on other shapes; P parts without the body.

    Attributes
    ----------
    given : GivenParts
    table : Parts
        Of the reference, the body included.
    level : int
        Of the reference.
    shares : (n, P) sparse
        Share of the area around each point of the reference that each part covers, with all that grows out of it; by
        exact labels, so that partners do not depend on where borders are shown.
    is_inside : (P, P) bool
        Whether the first part grows out of the second, directly or not.
    least_persistence : float
        Of the pairs that the reference's level keeps, as a fraction of the field's range.
    """

    given: GivenParts
    table: Parts
    level: int
    shares: csr_array
    is_inside: Bools
    least_persistence: float


def reference_parts(labels: Ints, parts: Parts, level: int, reference: Divisible) -> ReferenceParts:
    """Return the parts of a division of the reference's faces in the form that they are looked for on other shapes."""
    given = given_parts(labels, parts, reference)
    is_inside = _nesting(given.id, given.parent)
    exact = exact_labels(labels.astype(np.int32), reference.part_tree, reference.graph)
    whole = given_parts(exact.astype(np.int64), parts, reference).shares[:, 1:] @ (
        is_inside | np.eye(len(given.id), dtype=bool)
    ).astype(float)
    least = _least_persistence(reference.part_tree.hierarchy, level)
    return ReferenceParts(
        given=given,
        table=parts,
        level=level,
        shares=csr_array(whole),
        is_inside=is_inside,
        least_persistence=least,
    )


def _least_persistence(hierarchy: Hierarchy, level: int) -> float:
    kept = hierarchy.persistence[len(hierarchy.persistence) - level :]
    return float(kept.min(initial=hierarchy.value_range) / max(hierarchy.value_range, np.finfo(float).tiny))


def _nesting(ids: Ints, parents: Ints) -> Bools:
    is_inside = parents[:, None] == ids
    for _ in ids:
        is_inside = is_inside | (is_inside.astype(int) @ is_inside.astype(int) > 0)
    return is_inside


def partner_cuts(reference: ReferenceParts, target: Divisible, point_map: Ints) -> tuple[list[Ints], int]:
    """Return (A,) for each of the target's trees the part cut off at each arc, 0 where none is, and the target's level.

    For every part of the reference the subtree of the target's merge trees is taken that covers the same points best,
    at whatever level it stands there. What else the target has that is as persistent as the reference's parts gets
    labels of its own, above all of the reference's.

    Parameters
    ----------
    reference : ReferenceParts
    target : Divisible
    point_map : (n,) int64
        The reference's point that each of the target's points corresponds to.
    """
    part_tree, shape = target.part_tree, target.shape
    level = part_tree.hierarchy.level_of_threshold(reference.least_persistence)
    target_shares = reference.shares[point_map]
    covers = []
    for tree, arc_of_face in zip(part_tree.trees, part_tree.arcs_of_faces, strict=True):
        covers.append(_cover(tree, shape.shares_at_points(arc_of_face[target.face], len(tree.parent)), target_shares))
    first_free = 1 + reference.given.highest
    cuts = [np.zeros(len(cover.overlap), dtype=np.int64) for cover in covers]
    for part, tree_number, arc in _partners(reference, covers):
        cuts[tree_number][arc] = reference.given.id[part]
    for number, cut in enumerate(part_tree.cut_arcs(level, FEATURES)):
        is_free = _apart_from(np.flatnonzero(cuts[number]), covers[number]) & (cut != BODY)
        cuts[number][is_free] = first_free + cut[is_free]
    return cuts, level


def with_first_free(cuts: list[Ints], highest_shared: int, first_free: int) -> list[Ints]:
    """Renumber the parts without a partner from a number on, so that no other shape has their labels."""
    parts = np.unique(np.concatenate(cuts))
    unshared = parts[parts > highest_shared]
    return [np.where(cut > highest_shared, first_free + np.searchsorted(unshared, cut), cut) for cut in cuts]


@dataclass(frozen=True, eq=False)
class _Cover:
    """The overlap of the subtrees of a merge tree with the reference's parts; A arcs, P parts.

    Attributes
    ----------
    overlap : (A, P) float64
        Area covered by both, as a fraction of the area covered by either.
    is_inside : (A, A) bool
        Whether the first arc lies in the subtree of the second.
    """

    overlap: Floats
    is_inside: Bools


def _cover(tree: ArcTree, arcs_at_points: csr_array, parts_at_points: csr_array) -> _Cover:
    is_inside = _inside_arcs(tree.parent)
    subtrees = (is_inside | np.eye(len(is_inside), dtype=bool)).astype(float).T
    both = subtrees @ (arcs_at_points.T @ parts_at_points).toarray()
    arc_area = subtrees @ np.asarray(arcs_at_points.sum(axis=0)).ravel()
    part_area = np.asarray(parts_at_points.T @ np.asarray(arcs_at_points.sum(axis=1)).ravel()).ravel()
    either = arc_area[:, None] + part_area - both
    overlap = both / np.maximum(either, np.finfo(float).tiny)
    # The root is not cut off anywhere.
    overlap[tree.parent < 0] = 0.0
    return _Cover(overlap, is_inside)


def _inside_arcs(parent: Ints) -> Bools:
    is_inside = np.zeros((len(parent), len(parent)), dtype=bool)
    # A parent has a larger index than its children.
    for arc in range(len(parent) - 1, -1, -1):
        if parent[arc] >= 0:
            is_inside[arc] = is_inside[parent[arc]]
            is_inside[arc, parent[arc]] = True
    return is_inside


def _partners(reference: ReferenceParts, covers: list[_Cover]) -> list[tuple[int, int, int]]:
    """Return (part, tree, arc) of all partners: the best overlaps first that are nested as the parts are."""
    partners: list[tuple[int, int, int]] = []
    for part, tree, arc in _by_overlap(covers):
        if all(_fits((part, tree, arc), other, reference.is_inside, covers) for other in partners):
            partners.append((part, tree, arc))
    return partners


def _by_overlap(covers: list[_Cover]) -> list[tuple[int, int, int]]:
    rows, overlaps = [], []
    for tree, cover in enumerate(covers):
        arcs, parts = np.nonzero(cover.overlap >= LEAST_OVERLAP)
        rows += [(part, tree, arc) for arc, part in zip(arcs.tolist(), parts.tolist(), strict=True)]
        overlaps += cover.overlap[arcs, parts].tolist()
    even = evened(np.array(overlaps)).tolist()
    return [row for _, row in sorted(zip((-overlap for overlap in even), rows, strict=True))]


def _fits(one: tuple[int, int, int], other: tuple[int, int, int], nesting: Bools, covers: list[_Cover]) -> bool:
    """Whether two pairs of partners have different parts and arcs, nested alike."""
    (part, tree, arc), (other_part, other_tree, other_arc) = one, other
    if part == other_part or (tree, arc) == (other_tree, other_arc):
        return False
    if tree != other_tree:
        return not (nesting[part, other_part] or nesting[other_part, part])
    inside = covers[tree].is_inside
    alike = inside[arc, other_arc] == nesting[part, other_part]
    return bool(alike and inside[other_arc, arc] == nesting[other_part, part])


def _apart_from(taken: Ints, cover: _Cover) -> Bools:
    """Return (A,) the arcs that are neither taken nor inside or around one that is."""
    inside = cover.is_inside
    related = inside[:, taken].any(axis=1) | inside[taken].any(axis=0)
    related[taken] = True
    return ~related
