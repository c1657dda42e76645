"""Parts of a level: labels for the faces and a table of what they are."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from ...choices import FEATURES, JOINTED, NESTED, READINGS
from ...errors import LevelError
from ...surface.mesh import Floats, Ints, sum_by
from ..borders.level_set_borders import Polyline
from ..edits.corrections import LEVEL, Corrections, Labelling, corrected
from ..faces.branches import Branches, repaired_labels
from ..faces.part_tree import PartTree

BODY = 0


NOTHING_STANDS_OUT = 'No part stands out, so all is one part; the mode "Features" divides it nevertheless.'


@dataclass(frozen=True, eq=False)
class Parts:
    """The parts of a segmentation, one row each, the body first if it has faces.

    Attributes
    ----------
    id : (P,) int64
        Label of the part; 0 is the body. A part has the same id at every level.
    parent : (P,) int64
        Id of the part in the table that it grows out of; 0 for the body, and for what grows out of the body or of
        nothing.
    extremum, saddle : (P,) int64
        Net vertices: the tip of the part and the saddle it is cut off at; -1 for the body, and no saddle for what ends
        at a joint.
    area : (P,) float64
        In the mesh's unit of length, squared.
    n_triangles : (P,) int64
        How many faces carry the label.
    mirror : (P,) int64
        Id of the part in the table that a symmetry of the shape maps it onto; -1 where there is none.
    """

    id: Ints
    parent: Ints
    extremum: Ints
    saddle: Ints
    area: Floats
    n_triangles: Ints
    mirror: Ints

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
    resting : tuple of int
        The places of corrections that have nothing to do at this level.
    """

    level: int
    of_branch: Ints
    parts: Parts
    warnings: tuple[str, ...] = ()
    resting: tuple[int, ...] = ()

    def of_faces(self, part_tree: PartTree) -> NDArray[np.int32]:
        """Return the label (F,) of each face from its branch."""
        return self.of_branch.astype(np.int32)[part_tree.branches[0].of_face]


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

    Examples
    --------
    >>> segmentation = analysis.segment()
    >>> areas = dict(zip(segmentation.parts.id.tolist(), segmentation.parts.area.round(1).tolist()))
    >>> len(areas) == segmentation.n_parts
    True
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
            If the parts were carried over from another mesh, so that no level sets bound them.
        """
        if self._trace is None:
            raise LevelError("Only parts of the mesh's own field have borders inside triangles; these end at edges.")
        return self._trace()

    @cached_property
    def n_parts(self) -> int:
        """Number of different labels, the body included if it has faces."""
        return len(self.parts)


def label_branches(
    part_tree: PartTree,
    *,
    level: int | None = None,
    threshold: float | None = None,
    n_parts: int | None = None,
    mode: str = NESTED,
    corrections: Corrections | None = None,
) -> BranchLabels:
    """Label the branches at one level.

    Parameters
    ----------
    part_tree : PartTree
    level : int, optional
        From 0 (all is body) to ``hierarchy.n_levels - 1``; the default level if none of the three is given.
    threshold : float, optional
        Least persistence of a part, as a fraction of the field's range.
    n_parts : int, optional
        Number of labels, the body included; where it cannot be reached, the largest below it.
    mode : "nested", "features" or "jointed"
        The features and what lies between them when all levels up to this one are overlaid, or the features alone, or
        the first with limbs cut at their joints.
    corrections : Corrections, optional
        Changes made by hand; they refer to these branches.

    Raises
    ------
    LevelError
        If the level or the mode does not exist, or more than one of the three choices is given.
    """
    if mode not in READINGS:
        raise LevelError(f'The mode is "features" or "nested", not "{mode}".')
    if sum(choice is not None for choice in (level, threshold, n_parts)) > 1:
        raise LevelError("Give a level, a threshold or a number of parts, not several of them.")
    hierarchy, at_level = part_tree.hierarchy, partial(_at_level, part_tree, mode, corrections or Corrections())
    if n_parts is not None:
        return _reach_number(at_level, hierarchy.n_levels, n_parts)
    if level is None:
        level = hierarchy.default_level if threshold is None else hierarchy.level_of_threshold(threshold)
    labels = at_level(hierarchy.checked_level(level))
    if mode != FEATURES and labels.level >= max(1, hierarchy.default_level) and len(labels.parts) == 1:
        return replace(labels, warnings=(NOTHING_STANDS_OUT,))
    return labels


def reading_of(mode: str, joints: bool | None) -> str:
    """Return how levels are read: in a mode, with or without joints; if None, with joints in nested parts.

    Raises
    ------
    LevelError
        If joints are asked for among features alone.
    """
    if joints is None:
        return JOINTED if mode == NESTED else mode
    if not joints:
        return mode
    if mode != NESTED:
        raise LevelError('Joints are cut in nested parts only; choose the mode "nested", or leave joints out.')
    return JOINTED


def mode_of(reading: str) -> str:
    """Return the mode of a way in which levels are read: joints are cut in nested parts."""
    return NESTED if reading == JOINTED else reading


def _at_level(part_tree: PartTree, mode: str, corrections: Corrections, level: int) -> BranchLabels:
    cuts = part_tree.cut_arcs(level, mode, corrections.branch_levels)
    return label_behind(cuts, part_tree, level, corrections)


def label_behind(
    cuts: list[Ints], part_tree: PartTree, level: int, corrections: Corrections | None = None
) -> BranchLabels:
    """Label all branches by the part that is cut off next to them, as given for each arc of each tree."""
    corrections = corrections or Corrections()
    origins, branches, bodies = _origins(part_tree, cuts), part_tree.branches[0], part_tree.bodies
    of_branch = repaired_labels(part_tree.labels_of_branches(cuts), branches, bodies)
    labelling = Labelling(of_branch, origins.parent, _resting_levels(cuts, corrections), bodies)
    if corrections.items:
        labelling = corrected(labelling, branches, corrections)
    parts = _tabulate(labelling, origins, branches)
    return BranchLabels(level, labelling.of_branch, parts, resting=labelling.resting)


def _resting_levels(cuts: list[Ints], corrections: Corrections) -> tuple[int, ...]:
    """Return the places of the levels of branches whose part is not cut off."""
    present = set(np.concatenate(cuts).tolist())
    return tuple(row for row, item in enumerate(corrections.items) if item.kind == LEVEL and item.part not in present)


def _reach_number(at_level: Callable[[int], BranchLabels], n_levels: int, n_parts: int) -> BranchLabels:
    """Return the lowest level with that many labels, or with the most below it."""
    if n_parts < 1:
        raise LevelError(f"The number of parts is at least 1, not {n_parts}.")
    best = at_level(0)
    for level in range(1, n_levels):
        labels = at_level(level)
        if len(labels.parts) > n_parts:
            break
        if len(labels.parts) > len(best.parts):
            best = labels
    if len(best.parts) == n_parts:
        return best
    warning = f"This shape cannot be divided into exactly {n_parts} parts; it has {len(best.parts)} now."
    return replace(best, warnings=(warning,))


@dataclass(frozen=True, eq=False)
class _Origins:
    """By number of the part: what it grows out of, its tip, the saddle it is cut off at, and its twin."""

    parent: Ints
    extremum: Ints
    saddle: Ints
    mirror: Ints


def _origins(part_tree: PartTree, cuts: list[Ints]) -> _Origins:
    n = 1 + max(int(cut.max(initial=0)) for cut in cuts)
    parent, (extremum, saddle, mirror) = np.zeros(n, dtype=np.int64), np.full((3, n), -1)
    for tree, cut in zip(part_tree.trees, cuts, strict=True):
        arcs = np.flatnonzero(cut > BODY)
        extremum[cut[arcs]] = tree.extremum[arcs]
        saddle[cut[arcs]] = np.where(tree.is_neck[arcs], -1, tree.saddle[arcs])
        parent[cut[arcs]] = tree.spread(cut)[tree.parent[arcs]]
        twin = cut[tree.twin[arcs]]
        mirror[cut[arcs]] = np.where((twin > BODY) & (twin != cut[arcs]), twin, -1)
    return _Origins(parent, extremum, saddle, mirror)


def _tabulate(labelling: Labelling, origins: _Origins, pieces: Branches) -> Parts:
    area = sum_by(labelling.of_branch, pieces.area)
    n_faces = sum_by(labelling.of_branch, pieces.n_faces.astype(float)).astype(np.int64)
    ids = np.flatnonzero(n_faces > 0)
    n_new = max(0, len(labelling.parent) - len(origins.saddle))
    extremum, saddle, mirror = (
        np.pad(column, (0, n_new), constant_values=-1)[ids]
        for column in (origins.extremum, origins.saddle, origins.mirror)
    )
    return Parts(
        id=ids,
        parent=listed_parents(labelling.parent, ids)[ids],
        extremum=extremum,
        saddle=saddle,
        area=area[ids],
        n_triangles=n_faces[ids],
        mirror=np.where(np.isin(mirror, ids), mirror, -1),
    )


def listed_parents(parent: Ints, ids: Ints) -> Ints:
    """Return for each number of a part the nearest of the listed parts around it, the body where there is none.

    Parameters
    ----------
    parent : (n,) int64
        By number of the part, the part it grows out of, whether that has faces or not.
    ids : (P,) int64
        Parts that have faces.
    """
    is_listed = np.zeros(len(parent), dtype=bool)
    is_listed[ids] = True
    # Each round halves the way; what goes round in a circle grows out of nothing.
    for _ in range(len(parent).bit_length()):
        parent = np.where(is_listed[parent], parent, parent[parent])
    return np.where(is_listed[parent], parent, BODY)
