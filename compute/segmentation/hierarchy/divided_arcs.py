"""Arc trees whose arcs are divided at necks, with all that is known of their arcs."""

from dataclasses import dataclass, fields, replace
from typing import TypeVar

import numpy as np

from ...fields.scalar_field import ScalarField
from ...surface.mesh import Floats, Ints
from ...surface.ties import ROUNDING
from .arc_measures import ArcMeasures
from .arc_tree import NEVER, NO_ARC, NO_NECK, ArcTree
from .levels import DEFAULT_THRESHOLD, Hierarchy
from .necks import Necks, find_necks

AnyColumn = TypeVar("AnyColumn", Ints, Floats)


def with_necks(
    hierarchy: Hierarchy, arcs: tuple[Ints, ...], measures: tuple[ArcMeasures, ...], field: ScalarField
) -> tuple[Hierarchy, tuple[Ints, ...], tuple[ArcMeasures, ...]]:
    """Divide the arcs of limbs at their necks; all that is read from the trees without joints stays as it was.

    Parameters
    ----------
    hierarchy : Hierarchy
    arcs : tuple of (n,) int64
        For each tree, the arc of each vertex of the field's net.
    measures : tuple of ArcMeasures
        For each tree.
    field : ScalarField
    """
    found = [
        find_necks(tree, arc, field, hierarchy.default_level) for tree, arc in zip(hierarchy.trees, arcs, strict=True)
    ]
    strength = np.concatenate([necks.strength for necks in found])
    place = np.empty(len(strength), dtype=np.int64)
    place[np.argsort(-strength, kind="stable")] = np.arange(len(strength))
    numbers = np.split(place, np.cumsum([len(necks.arc) for necks in found])[:-1])
    pieces = [_pieces(necks, tree, arc, field) for necks, tree, arc in zip(found, hierarchy.trees, arcs, strict=True)]
    trees = tuple(
        replace(
            _divided_tree(tree, own),
            neck=own.of_necks(np.full(len(own.old), NO_NECK), number),
            neck_closing=own.of_necks(np.full(len(own.old), NEVER), _closing(hierarchy, tree, own.necks)),
            n_necks=len(strength),
        )
        for tree, own, number in zip(hierarchy.trees, pieces, numbers, strict=True)
    )
    sizes = tuple(_divided_measures(of_arcs, own) for of_arcs, own in zip(measures, pieces, strict=True))
    return replace(hierarchy, trees=trees), tuple(own.of_vertex for own in pieces), sizes


def _closing(hierarchy: Hierarchy, tree: ArcTree, necks: Necks) -> Ints:
    """Return how many pairs are kept where each neck begins to count: those that are stronger, and its limb's.

    A neck of strength 1 is as strong as a pair at the default threshold.
    """
    level, last = hierarchy.default_level, hierarchy.n_levels - 2
    falling = hierarchy.persistence[::-1][: last + 1]
    threshold = necks.strength * DEFAULT_THRESHOLD * hierarchy.value_range
    stronger = (falling > threshold[:, None] + ROUNDING * hierarchy.value_range).sum(axis=1)
    # The last level shows all that there is beyond the default one.
    closing = np.where(
        necks.strength >= 1, np.minimum(stronger, level - 1), np.maximum(np.minimum(stronger, last), level)
    )
    return np.maximum(closing, tree.joint_closing[necks.limb])


@dataclass(frozen=True, eq=False)
class _Pieces:
    """The pieces that necks divide the arcs of a tree into, P pieces of A arcs with k necks.

    Attributes
    ----------
    necks : Necks
    old : (P,) int64
        The arc that each is a piece of; those of an arc follow each other, the innermost first.
    first, last : (A,) int64
        The innermost and the outermost piece of each arc.
    at_neck : (k,) int64
        The piece that closes at each neck.
    of_vertex : (n,) int64
        The piece that each vertex of the net lies on.
    """

    necks: Necks
    old: Ints
    first: Ints
    last: Ints
    at_neck: Ints
    of_vertex: Ints

    def of_necks(self, column: AnyColumn, values: AnyColumn | int) -> AnyColumn:
        """Return a column (P,) with other values for the pieces that close at necks."""
        column = column.copy()
        column[self.at_neck] = values
        return column


def _pieces(necks: Necks, tree: ArcTree, arc: Ints, field: ScalarField) -> _Pieces:
    rising = -field.values if tree.is_of_maxima else field.values
    count = 1 + np.bincount(necks.arc, minlength=len(tree.parent))
    last = np.cumsum(count) - 1
    first = last - count + 1
    order = np.lexsort((rising[necks.vertex], necks.arc))
    sorted_arc = necks.arc[order]
    at_neck = np.empty(len(order), dtype=np.int64)
    at_neck[order] = first[sorted_arc] + np.arange(len(order)) - np.searchsorted(sorted_arc, sorted_arc)
    of_vertex = first[arc]
    for on, vertex in zip(necks.arc.tolist(), necks.vertex.tolist(), strict=True):
        of_vertex += (arc == on) & (rising >= rising[vertex])
    return _Pieces(necks, np.repeat(np.arange(len(count)), count), first, last, at_neck, of_vertex)


def _divided_tree(tree: ArcTree, pieces: _Pieces) -> ArcTree:
    """Return a tree with its arcs in pieces; those that close at necks are cut off at no level."""
    old, at_neck, necks = pieces.old, pieces.at_neck, pieces.necks
    parent = np.where(tree.is_root, NO_ARC, pieces.first[tree.parent])
    return replace(
        tree,
        parent=pieces.of_necks(parent[old], at_neck + 1),
        part=tree.part[old],
        extremum=tree.extremum[old],
        saddle=pieces.of_necks(tree.saddle[old], necks.vertex),
        closing=pieces.of_necks(tree.closing[old], NEVER),
        joint_part=tree.joint_part[old],
        joint_closing=pieces.of_necks(tree.joint_closing[old], NEVER),
        twin=pieces.of_necks(pieces.last[tree.twin][old], at_neck[necks.twin]),
    )


def _divided_measures(measures: ArcMeasures, pieces: _Pieces) -> ArcMeasures:
    """Return the measures of pieces: the outermost of each arc has those of the arc."""
    columns = {
        column.name: pieces.of_necks(getattr(measures, column.name)[pieces.old], 0) for column in fields(measures)
    }
    return ArcMeasures(**columns)
