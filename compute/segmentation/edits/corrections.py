"""Changes by hand on top of any level: kept apart from the levels, applied in the order they were made.

A correction names parts by their numbers, which a part has at every level; where a level does not have them the
correction rests.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ...choices import NESTED
from ...surface.mesh import Floats, Ints
from ...surface.ties import first_largest
from ..faces.branches import Branches, repaired_labels

# A level of its own for what lies inside a part; its border stays.
LEVEL = "level"
# A part becomes a piece of another one that it touches.
MERGE = "merge"
# What lies beyond a level set across a part becomes a part.
SPLIT = "split"
# The border of a part lies at another level set.
MOVE = "move"
# Faces that were given to a part.
PAINT = "paint"
CORRECTION_KINDS = (LEVEL, MERGE, SPLIT, MOVE, PAINT)

# Where a branch lies in relation to a border along the field: out of its reach, in reach but not beyond it, beyond it.
AWAY, BEFORE, BEYOND = 0, 1, 2
NOT_PAINTED = -1


@dataclass(frozen=True)
class Correction:
    """One change.

    Attributes
    ----------
    kind : str
        One of ``CORRECTION_KINDS``.
    part : int
        The part that is changed; for ``PAINT`` the one that gets the faces.
    other : int
        For ``MERGE`` the part it becomes a piece of, for ``SPLIT`` the number of the new part, for ``PAINT`` 1 if the
        part consists of painted faces only.
    value : float
        For ``LEVEL`` the level; for ``SPLIT`` how far the new border lies inside the part, as a fraction of the
        field's range; for ``MOVE`` how far the border is moved outward, likewise.
    level, mode
        The division on which the change was made, in which the part is found again.
    """

    kind: str
    part: int
    other: int = 0
    value: float = 0.0
    level: int = 0
    mode: str = NESTED


@dataclass(frozen=True, eq=False)
class Corrections:
    """All changes, with what they mean for B branches.

    Attributes
    ----------
    items : tuple of Correction
        In the order in which they are applied; painting comes last of all.
    side : (n, B) int8
        For each change that has to do with a border along the field, where each branch lies in relation to it.
    painted : (B,) int64
        The part each branch was painted with, ``NOT_PAINTED`` elsewhere.
    """

    items: tuple[Correction, ...] = ()
    side: Ints = field(default_factory=lambda: np.zeros((0, 0), dtype=np.int64))
    painted: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    @property
    def branch_levels(self) -> tuple[tuple[int, int], ...]:
        """(part, level) of all parts that have a level of their own."""
        return tuple((item.part, int(item.value)) for item in self.items if item.kind == LEVEL)

    @property
    def highest_part(self) -> int:
        """The highest number that a change mentions."""
        return max((max(item.part, item.other) for item in self.items), default=0)


@dataclass(frozen=True, eq=False)
class Labelling:
    """Parts of branches while they are corrected.

    Attributes
    ----------
    of_branch : (B,) int64
        The part of each branch.
    parent : (n,) int64
        By number of the part, the part it grows out of.
    resting : tuple of int
        The places of changes that had nothing to do.
    bodies : tuple of int
        Parts that may be in pieces: what is left of each shell.
    """

    of_branch: Ints
    parent: Ints
    resting: tuple[int, ...] = ()
    bodies: tuple[int, ...] = (0,)


def corrected(labelling: Labelling, branches: Branches, corrections: Corrections) -> Labelling:
    """Apply all changes but levels of branches, which the labels have already; parts are connected before painting."""
    steps: dict[str, Callable[..., Labelling | None]] = {MERGE: _merge, SPLIT: _split, MOVE: _move}
    resting = list(labelling.resting)
    missing = corrections.highest_part + 1 - len(labelling.parent)
    labelling = replace(labelling, parent=np.pad(labelling.parent, (0, max(0, missing))))
    for row, item in enumerate(corrections.items):
        if item.kind in steps:
            side = corrections.side[row] if item.kind != MERGE else None
            done = steps[item.kind](labelling, branches, item, side)
            resting += [row] if done is None else []
            labelling = done or labelling
    whole = replace(labelling, of_branch=repaired_labels(labelling.of_branch, branches, labelling.bodies))
    return _painted(whole, branches, corrections, resting)


def touching(of_branch: Ints, branches: Branches, part: int) -> dict[int, float]:
    """Return the length of the border with each part that a part touches."""
    ends = of_branch[branches.borders]
    lengths: dict[int, float] = {}
    for inner, outer in (ends.T, ends[:, ::-1].T):
        outward = (inner == part) & (outer != part)
        for other, length in zip(outer[outward].tolist(), branches.border_length[outward].tolist(), strict=True):
            lengths[other] = lengths.get(other, 0.0) + length
    return lengths


def _merge(labelling: Labelling, branches: Branches, item: Correction, _: Ints | None) -> Labelling | None:
    part, into = item.part, item.other
    if into not in touching(labelling.of_branch, branches, part):
        return None
    of_branch = np.where(labelling.of_branch == part, into, labelling.of_branch)
    parent = labelling.parent.copy()
    if part in _around(parent, into):
        parent[into] = parent[part]
    parent[(parent == part) & (np.arange(len(parent)) != into)] = into
    return replace(labelling, of_branch=of_branch, parent=parent)


def _around(parent: Ints, part: int) -> list[int]:
    """Return the parts that a part grows out of, from the next one outward."""
    around: list[int] = []
    while (part := int(parent[part])) not in around:
        around.append(part)
    return around


def _split(labelling: Labelling, branches: Branches, item: Correction, side: Ints) -> Labelling | None:
    is_inside = labelling.of_branch == item.part
    beyond = is_inside & (side == BEYOND)
    if not beyond.any() or not (is_inside & ~beyond).any():
        return None
    of_branch = np.where(beyond, item.other, labelling.of_branch)
    parent = labelling.parent.copy()
    parent[item.other] = item.part
    for child in np.flatnonzero(labelling.parent == item.part).tolist():
        lengths = touching(of_branch, branches, child)
        if child != item.other and lengths.get(item.other, 0.0) > lengths.get(item.part, 0.0):
            parent[child] = item.other
    return replace(labelling, of_branch=of_branch, parent=parent)


def _move(labelling: Labelling, _: Branches, item: Correction, side: Ints) -> Labelling | None:
    part, outside = item.part, int(labelling.parent[item.part])
    loses = (labelling.of_branch == part) & (side == BEFORE)
    gains = (labelling.of_branch == outside) & (side == BEYOND)
    of_branch = np.where(loses, outside, np.where(gains, part, labelling.of_branch))
    if not (loses | gains).any() or not (of_branch == part).any() or not (labelling.of_branch == part).any():
        return None
    return replace(labelling, of_branch=of_branch)


def _painted(labelling: Labelling, branches: Branches, corrections: Corrections, resting: list[int]) -> Labelling:
    of_branch, parent = labelling.of_branch.copy(), labelling.parent.copy()
    for row, item in enumerate(corrections.items):
        if item.kind == PAINT:
            rows = corrections.painted == item.part
            exists = bool(item.other) or bool((labelling.of_branch == item.part).any())
            if not exists or not rows.any():
                resting.append(row)
                continue
            if item.other:
                parent[item.part] = _most_common(labelling.of_branch[rows], branches.area[rows])
            of_branch[rows] = item.part
    return replace(labelling, of_branch=of_branch, parent=parent, resting=tuple(resting))


def _most_common(labels: Ints, area: Floats) -> int:
    return int(first_largest(np.bincount(labels, area)))
