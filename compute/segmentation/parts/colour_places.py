"""Places in a list of colours for parts: unlike for parts that are shown together, the same at every level."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...choices import READINGS
from ...surface.mesh import Ints
from ..faces.part_tree import PartTree
from .part_labels import BODY, BranchLabels, label_branches

# Levels that colours are chosen for at once, two to four times as many as characters have; on a mesh that is all noise,
# neighbours of finer levels get other colours when they are shown.
LEVELS_AHEAD = 64


@dataclass(frozen=True)
class VisibleParts:
    """Parts that are shown together.

    Attributes
    ----------
    parts : tuple of int
        Their numbers in order, without the body.
    touching : frozenset of (int, int)
        Those of them that have a border with each other, the smaller number first.
    """

    parts: tuple[int, ...]
    touching: frozenset[tuple[int, int]] = frozenset()


@dataclass(eq=False)
class _Places:
    """Places as they are given, one part after the other."""

    n_colours: int
    beside: dict[int, set[int]] = field(default_factory=dict)
    rivals: dict[int, set[int]] = field(default_factory=dict)
    given: dict[int, int] = field(default_factory=dict)

    def see(self, shown: VisibleParts) -> None:
        """Note who is shown with whom, and who must not look alike."""
        has_enough = len(shown.parts) <= self.n_colours
        for part in shown.parts:
            self.beside.setdefault(part, set()).update(shown.parts)
            self.rivals.setdefault(part, set()).update(shown.parts if has_enough else ())
        for first, second in shown.touching:
            self.rivals[first].add(second)
            self.rivals[second].add(first)

    def counts(self, parts: set[int]) -> list[int]:
        """Return how many of some parts have each place."""
        taken = [self.given[part] for part in parts if part in self.given]
        return np.bincount(taken, minlength=self.n_colours).tolist()

    def give(self, part: int, kept: int | None) -> None:
        """Give a part the place it had if no rival has it, else the one that is rarest around it."""
        among_rivals, around = self.counts(self.rivals[part]), self.counts(self.beside[part])
        if kept is None or among_rivals[kept % self.n_colours]:
            kept = min(range(self.n_colours), key=lambda place: (among_rivals[place], around[place], place))
        self.given[part] = kept % self.n_colours


def colour_places(
    together: Iterable[VisibleParts], n_colours: int, kept: Mapping[int, int] | None = None
) -> dict[int, int]:
    """Return the place of each part in a list of colours.

    Parts that are shown together have different places as long as there are enough, and parts with a common border
    have different ones beyond that. The earlier a part is shown, the lower its place.

    Parameters
    ----------
    together : iterable of VisibleParts
        All that is ever shown, what is seen most first.
    n_colours : int
    kept : dict, optional
        Places that parts have already, and keep unless they must not look alike.

    Returns
    -------
    dict of int to int
        From 0 to ``n_colours - 1``, also those kept places that belong to no part here.

    Examples
    --------
    >>> colour_places([VisibleParts((1, 2)), VisibleParts((1, 2, 3))], 19)
    {1: 0, 2: 1, 3: 2}
    """
    places, kept = _Places(n_colours), kept or {}
    order: dict[int, None] = {}
    for shown in together:
        places.see(shown)
        order |= dict.fromkeys(shown.parts)
    # Those that have one come first, so that what is new gives way.
    for part in sorted(order, key=lambda part: part not in kept):
        places.give(part, kept.get(part))
    return {**kept, **places.given}


def places_at_all_levels(part_tree: PartTree, n_colours: int) -> dict[int, int]:
    """Return the place of each part of a tree in a list of colours, at whatever level and in whatever mode it is shown.

    Parameters
    ----------
    part_tree : PartTree
    n_colours : int

    Returns
    -------
    dict of int to int
    """
    default_level, n_levels = part_tree.hierarchy.default_level, min(LEVELS_AHEAD, part_tree.hierarchy.n_levels)
    levels = [default_level, *(level for level in range(n_levels) if level != default_level)]
    together = (
        visible_parts(label_branches(part_tree, level=level, mode=mode), part_tree)
        for mode in READINGS
        for level in levels
    )
    return colour_places(together, n_colours)


def visible_parts(labels: BranchLabels, part_tree: PartTree) -> VisibleParts:
    """Return the parts of a level with those that touch.

    Parameters
    ----------
    labels : BranchLabels
    part_tree : PartTree
        Whose branches they label.

    Returns
    -------
    VisibleParts

    Examples
    --------
    >>> visible_parts(label_branches(part_tree, level=0), part_tree).parts
    ()
    """
    ends = labels.of_branch[part_tree.branches[0].borders]
    return VisibleParts(tuple(part for part in labels.parts.id.tolist() if part != BODY), _touching(ends))


def _touching(ends: Ints) -> frozenset[tuple[int, int]]:
    """Return the different pairs (n, 2) of parts on both sides of borders."""
    pairs = np.sort(ends[(ends[:, 0] != ends[:, 1]) & (ends != BODY).all(axis=1)], axis=1)
    return frozenset(map(tuple, pairs.tolist()))
