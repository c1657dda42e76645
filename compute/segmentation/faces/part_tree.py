"""The part tree: the features of a shape with the faces they lie on, which every level is read from."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...choices import FEATURES, JOINTED, NESTED
from ...surface.mesh import Bools, Floats, Ints, sum_by
from ...surface.ties import ROUNDING
from ..hierarchy.arc_measures import ArcMeasures
from ..hierarchy.arc_tree import ArcTree
from ..hierarchy.levels import Hierarchy
from ..hierarchy.nesting import joint_cuts, nested_cuts, numbered
from .branches import Branches

# Peak memory of dividing the faces and of tracing their borders, for each vertex of the net (docs/method.md).
BYTES_PER_NODE = 400
TOO_MANY_FACES = (
    "Dividing {:,} faces takes about {} of memory, and {} are free; decimate the mesh or close other programs."
)


@dataclass(frozen=True, eq=False)
class PartTree:
    """The features of a shape and the faces of their arcs; F faces in B branches.

    A part is a subtree of one of the trees, so a level is a choice of arcs at which parts are cut off.

    Attributes
    ----------
    hierarchy : Hierarchy
    measures : tuple of ArcMeasures
        One for each tree of the hierarchy, as are the others.
    closing_heights : tuple of (A,) float64
        The value of the field at which each arc closes; not a number where it closes at no saddle.
    branches : tuple of Branches
        The faces of the arcs. Their pieces are the same in all trees.
    """

    hierarchy: Hierarchy
    measures: tuple[ArcMeasures, ...]
    closing_heights: tuple[Floats, ...]
    branches: tuple[Branches, ...]

    @property
    def trees(self) -> tuple[ArcTree, ...]:
        """The arc trees of the hierarchy."""
        return self.hierarchy.trees

    @property
    def n_faces(self) -> int:
        """Number of faces, F."""
        return len(self.branches[0].of_face)

    @property
    def arcs_of_faces(self) -> list[Ints]:
        """For each tree, the arc (F,) of each face."""
        return [pieces.arc[pieces.of_face] for pieces in self.branches]

    @property
    def shown_arcs_of_faces(self) -> list[Ints]:
        """For each tree, the arc (F,) whose part each face is shown in."""
        return [pieces.shown[pieces.of_face] for pieces in self.branches]

    @property
    def exact(self) -> "PartTree":
        """The same with each face shown in the part that has the greater half of it."""
        return replace(self, branches=tuple(replace(pieces, shown=pieces.arc) for pieces in self.branches))

    @property
    def bodies(self) -> tuple[int, ...]:
        """The parts that are left of the shells when all others are cut off; they may be in pieces."""
        return tuple(np.unique(self.trees[0].body).tolist())

    def faces_inside(self, tree: int, arc: int) -> Bools:
        """Mask (F,) of the faces in the part that is cut off at an arc of a tree."""
        pieces = self.branches[tree]
        return self.trees[tree].subtree(arc)[pieces.arc][pieces.of_face]

    def cut_arcs(self, level: int, mode: str = NESTED, branch_levels: tuple[tuple[int, int], ...] = ()) -> list[Ints]:
        """Return for each tree the part (A,) that is cut off at each arc on a level, 0 where nothing is.

        Parameters
        ----------
        level : int
        mode : "nested", "features" or "jointed"
        branch_levels : tuple of (part, level)
            Parts inside which another level counts; their own borders stay.
        """
        is_cut = self._cut_at_level(level, mode)
        cuts = self._numbered(is_cut)
        for part, own_level in branch_levels:
            inner = self._cut_at_level(min(own_level, self.hierarchy.n_levels - 1), mode)
            for number, tree in enumerate(self.trees):
                for arc in np.flatnonzero(cuts[number] == part).tolist():
                    inside = tree.subtree(arc)
                    inside[arc] = False
                    is_cut[number] = np.where(inside, inner[number], is_cut[number])
            cuts = self._numbered(is_cut)
        return cuts

    def pieces_of_parts(
        self, level: int, mode: str = NESTED, branch_levels: tuple[tuple[int, int], ...] = ()
    ) -> dict[int, int]:
        """Return for each part that is cut off on a level the place of its arc among those of all trees.

        The arc tells what piece of the surface it is: at other levels that may have another number.
        """
        cuts = np.concatenate(self.cut_arcs(level, mode, branch_levels))
        arcs = np.flatnonzero(cuts)
        return dict(zip(cuts[arcs].tolist(), arcs.tolist(), strict=True))

    def faces_of_piece(self, piece: int) -> Bools:
        """Mask (F,) of the faces of a piece, by the place of its arc among those of all trees."""
        for tree, arcs in enumerate(self.trees):
            if piece < len(arcs.parent):
                return self.faces_inside(tree, piece)
            piece -= len(arcs.parent)
        raise LookupError(piece)

    @property
    def ends(self) -> list[Bools]:
        """For each tree, the mask (A,) of the arcs at which parts end at some level, in any mode."""
        last, default_level = self.hierarchy.n_levels - 1, self.hierarchy.default_level
        # Beyond the default level nested parts only become more, and with joints they are the same and more.
        levels = {JOINTED: (*range(default_level + 1), last), FEATURES: range(last + 1)}
        cuts = [self._cut_at_level(level, mode) for mode, chosen in levels.items() for level in chosen]
        return [np.logical_or.reduce(of_tree) for of_tree in zip(*cuts, strict=True)]

    def labels_of_branches(self, cuts: list[Ints]) -> Ints:
        """Return the label (B,) of each branch, given the parts (A,) that are cut off at the arcs of each tree.

        Where parts of maxima and of minima overlap, the smaller one lies on top.
        """
        body = self.trees[0].body[self.branches[0].shown]
        labels, size = body, np.full(len(body), np.inf)
        for tree, pieces, cut in zip(self.trees, self.branches, cuts, strict=True):
            part = tree.spread(cut)
            label = part[pieces.shown]
            area = sum_by(part[pieces.arc], pieces.area, 1 + int(part.max()))[label]
            is_on_top = (label > 0) & (label != body) & (area < (1 - ROUNDING) * size)
            labels, size = np.where(is_on_top, label, labels), np.where(is_on_top, area, size)
        return labels

    def _numbered(self, is_cut: list[Bools]) -> list[Ints]:
        return [numbered(tree, cut) for tree, cut in zip(self.trees, is_cut, strict=True)]

    def _cut_at_level(self, level: int, mode: str) -> list[Bools]:
        """For each tree, the mask of the arcs that end a part."""
        if mode == FEATURES:
            return [tree.is_feature(level) for tree in self.trees]
        default_level, has_ends = self.hierarchy.default_level, len(self.trees) == 1
        cuts = [
            nested_cuts(tree, measures, shares, level=level, default_level=default_level, has_ends=has_ends)
            for tree, measures, shares in zip(self.trees, self.measures, self._shares_of_shells, strict=True)
        ]
        if mode == NESTED:
            return cuts
        return [
            is_cut
            | joint_cuts(tree, measures, shares, is_cut, level=level, default_level=default_level, has_ends=has_ends)
            for tree, measures, shares, is_cut in zip(
                self.trees, self.measures, self._shares_of_shells, cuts, strict=True
            )
        ]

    @cached_property
    def _shares_of_shells(self) -> list[Floats]:
        """For each tree, the share (A,) of each arc in the area of its shell."""
        return [_share_of_shell(tree, pieces) for tree, pieces in zip(self.trees, self.branches, strict=True)]


def _share_of_shell(tree: ArcTree, pieces: Branches) -> Floats:
    area = sum_by(pieces.arc, pieces.area, len(tree.part))
    whole = sum_by(tree.shell, area)[tree.shell]
    return area / np.where(whole > 0, whole, 1.0)
