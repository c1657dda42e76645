"""Parts of a level: labels for the faces and a table of what they are."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..errors import LevelError
from ..mesh import Floats, Ints
from .arc_tree import ArcTree
from .borders import Polyline
from .branches import Branches, repaired_labels
from .faces import sum_by
from .hierarchy import Hierarchy
from .nesting import nested_parts

BODY = 0
MODES = ("features", "nested")


@dataclass(frozen=True, eq=False)
class Parts:
    """The parts of a segmentation, one row each, the body first if it has faces.

    Attributes
    ----------
    id : (P,) int64
        Label of the part; 0 is the body. A part has the same id at every level.
    parent : (P,) int64
        Id of the part it grows out of; 0 for the body.
    extremum, saddle : (P,) int64
        Net vertices: the tip of the part and the saddle it is cut off at; -1 for the body.
    area : (P,) float64
        In the mesh's unit of length, squared.
    n_triangles : (P,) int64
        How many faces carry the label.
    """

    id: Ints
    parent: Ints
    extremum: Ints
    saddle: Ints
    area: Floats
    n_triangles: Ints

    def __len__(self) -> int:
        return len(self.id)


@dataclass(frozen=True, eq=False)
class BranchLabels:
    """A level as labels of branches: what is left to do for the faces is a look-up.

    Attributes
    ----------
    level : int
    of_branch : (B,) int64
        The part of each branch.
    parts : Parts
    warnings : tuple of str
    """

    level: int
    of_branch: Ints
    parts: Parts
    warnings: tuple[str, ...] = ()

    def of_faces(self, branches: tuple[Branches, ...]) -> NDArray[np.int32]:
        """Return the label of each face from its branch."""
        return self.of_branch.astype(np.int32)[branches[0].of_face]


@dataclass(frozen=True, eq=False)
class Segmentation:
    """The faces of a mesh divided into parts.

    Attributes
    ----------
    labels : (T,) int32
        Part of each triangle of the input; 0 is the body.
    parts : Parts
    level : int
    warnings : tuple of str
        Sentences for the user, such as that a number of parts could not be reached.
    """

    labels: NDArray[np.int32]
    parts: Parts
    level: int
    warnings: tuple[str, ...] = ()
    _trace: Callable[[], tuple[Polyline, ...]] | None = field(default=None, repr=False)

    @cached_property
    def borders(self) -> tuple[Polyline, ...]:
        """The lines inside the triangles where parts end, made when first asked for.

        Raises
        ------
        LevelError
            If the parts are not those of one level of one field, so that no level sets bound them.
        """
        if self._trace is None:
            raise LevelError("Only the parts of one level have borders inside triangles; these end at edges.")
        return self._trace()

    @cached_property
    def n_parts(self) -> int:
        """Number of different labels, the body included if it has faces."""
        return len(self.parts)


def label_branches(
    hierarchy: Hierarchy,
    branches: tuple[Branches, ...],
    *,
    level: int | None = None,
    threshold: float | None = None,
    n_parts: int | None = None,
    mode: str = "features",
) -> BranchLabels:
    """Label the branches at one level.

    Parameters
    ----------
    hierarchy : Hierarchy
    branches : tuple of Branches
        One for each tree of the hierarchy.
    level : int, optional
        From 0 (all is body) to ``hierarchy.n_levels - 1``.
    threshold : float, optional
        Least persistence of a part, as a fraction of the field's range.
    n_parts : int, optional
        Number of labels, the body included; where it cannot be reached, the largest below it.
    mode : "features" or "nested"
        Only the features, or also what lies between them when all levels up to this one are overlaid.

    Raises
    ------
    LevelError
        If the level or the mode does not exist, or more than one of the three choices is given.
    """
    if mode not in MODES:
        raise LevelError(f'The mode is "features" or "nested", not "{mode}".')
    if sum(choice is not None for choice in (level, threshold, n_parts)) > 1:
        raise LevelError("Give a level, a threshold or a number of parts, not several of them.")
    if n_parts is not None:
        return _reach_number(hierarchy, branches, n_parts, mode)
    if level is None:
        level = hierarchy.default_level if threshold is None else hierarchy.level_of_threshold(threshold)
    return _at_level(hierarchy, branches, hierarchy.checked_level(level), mode)


def _at_level(hierarchy: Hierarchy, branches: tuple[Branches, ...], level: int, mode: str) -> BranchLabels:
    return label_behind(cut_arcs(hierarchy, branches, level, mode), hierarchy, branches, level)


def cut_arcs(hierarchy: Hierarchy, branches: tuple[Branches, ...], level: int, mode: str = "features") -> list[Ints]:
    """Return for each tree the part that is cut off at each arc on a level, 0 where nothing is."""
    default_level = hierarchy.default_level
    return [
        _cut_arcs(tree, pieces, level, default_level, mode)
        for tree, pieces in zip(hierarchy.trees, branches, strict=True)
    ]


def label_behind(cuts: list[Ints], hierarchy: Hierarchy, branches: tuple[Branches, ...], level: int) -> BranchLabels:
    """Label all branches by the part that is cut off next to them, as given for each arc of each tree."""
    of_branch = repaired_labels(_overlaid(cuts, hierarchy, branches), branches[0])
    return BranchLabels(level, of_branch, _tabulate(hierarchy, branches[0], cuts, of_branch))


def _overlaid(cuts: list[Ints], hierarchy: Hierarchy, branches: tuple[Branches, ...]) -> Ints:
    """Return the label of each branch; where parts of maxima and of minima overlap, the smaller one lies on top."""
    overlaid, size = np.zeros(len(branches[0].arc), dtype=np.int64), np.full(len(branches[0].arc), np.inf)
    for tree, pieces, cut in zip(hierarchy.trees, branches, cuts, strict=True):
        label = tree.spread(cut)[pieces.arc]
        area = sum_by(label, pieces.area)[label]
        is_on_top = (label > BODY) & (area < size)
        overlaid, size = np.where(is_on_top, label, overlaid), np.where(is_on_top, area, size)
    return overlaid


def _cut_arcs(tree: ArcTree, pieces: Branches, level: int, default_level: int, mode: str) -> Ints:
    """Return the part that is cut off at each arc, 0 where nothing is."""
    if mode == "features":
        return np.where(tree.is_feature(level), tree.part, BODY)
    area = sum_by(pieces.arc, pieces.area, len(tree.part)) / pieces.area.sum()
    return nested_parts(tree, level, default_level, area)


def _reach_number(hierarchy: Hierarchy, branches: tuple[Branches, ...], n_parts: int, mode: str) -> BranchLabels:
    """Return the lowest level with that many labels, or with the most below it."""
    if n_parts < 1:
        raise LevelError(f"The number of parts is at least 1, not {n_parts}.")
    best = _at_level(hierarchy, branches, 0, mode)
    for level in range(1, hierarchy.n_levels):
        labels = _at_level(hierarchy, branches, level, mode)
        if len(labels.parts) > n_parts:
            break
        if len(labels.parts) > len(best.parts):
            best = labels
    if len(best.parts) == n_parts:
        return best
    warning = f"This shape cannot be divided into exactly {n_parts} parts; it has {len(best.parts)} now."
    return BranchLabels(best.level, best.of_branch, best.parts, (warning,))


def _tabulate(hierarchy: Hierarchy, pieces: Branches, cuts: list[Ints], of_branch: Ints) -> Parts:
    n_labels = 1 + int(of_branch.max(initial=0))
    parent, extremum, saddle = np.zeros(n_labels, dtype=np.int64), np.full(n_labels, -1), np.full(n_labels, -1)
    for tree, cut in zip(hierarchy.trees, cuts, strict=True):
        arcs = np.flatnonzero((cut > BODY) & (cut < n_labels))
        extremum[cut[arcs]], saddle[cut[arcs]] = tree.extremum[arcs], tree.saddle[arcs]
        parent[cut[arcs]] = tree.spread(cut)[tree.parent[arcs]]
    area = sum_by(of_branch, pieces.area)
    n_faces = sum_by(of_branch, pieces.n_faces.astype(float)).astype(np.int64)
    ids = np.flatnonzero(n_faces > 0)
    return Parts(ids, parent[ids], extremum[ids], saddle[ids], area[ids], n_faces[ids])
