"""The noise-free merge tree, cut into arcs at every saddle where a part may end.

A part is always a subtree, so a segmentation at any level is one label for each arc.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...surface.mesh import Bools, Ints

# In the place of an arc's parent: there is none, it is a root.
NO_ARC = -1
# In the place of the saddle at which an arc closes: it closes at none, since it is a root or a whole shell.
NO_SADDLE = -1
# In the place of a pair by falling persistence: the saddle has no pair and survives at every level.
ALWAYS = -1
# Likewise: no level reaches it. More than any number of pairs, and no more than a .blend can hold.
NEVER = int(np.iinfo(np.int32).max)
# In the place of a neck: the arc closes at none.
NO_NECK = -1


@dataclass(frozen=True, eq=False)
class ArcTree:
    """Arcs of a merge tree whose noise is cancelled.

    Attributes
    ----------
    is_of_maxima : bool
        Whether the leaves are maxima (superlevel sets) or minima (sublevel sets).
    n_roots : int
        Parts with the numbers 1 to this have no pair and survive always; the next numbers follow the pairs.
    n_features : int
        Pairs that are not noise, in all trees.
    parent : (A,) int64
        The arc that goes on behind the saddle at which this one closes, always of larger index; ``NO_ARC`` for the
        root. Around each further shell that was analyzed by itself there is an arc that closes at no saddle.
    part : (A,) int64
        The part named after the most extreme leaf above the arc.
    extremum : (A,) int64
        That leaf, a net vertex.
    saddle : (A,) int64
        Net vertex at which the arc closes; ``NO_SADDLE`` for whole shells and for roots, each shell's own included.
    closing : (A,) int64
        The place of that saddle's pair by falling persistence, the first of them if it has several: the saddle
        survives at all levels above. ``ALWAYS`` for saddles without a pair and for whole shells, which survive at every
        level, and ``NEVER`` for roots, each shell's own included.
    joint_part, joint_closing : (A,) int64
        The same for the two that a symmetry of the shape maps onto each other: the less of ``part`` and of ``closing``,
        so that twins appear and are cut off together. Equal to these where there is no twin.
    twin : (A,) int64
        The arc that a symmetry maps each arc onto; itself where there is none.
    neck : (A,) int64
        The place of the neck at which the arc closes by falling strength, over all trees; ``NO_NECK`` where it is
        none. At a neck a limb narrows, and the field has no saddle: ``saddle`` is a vertex of the level set there, and
        ``closing`` is ``NEVER``, so that no part ends there unless joints are asked for.
    neck_closing : (A,) int64
        How many pairs are stronger than the neck: it counts at all levels above. ``NEVER`` where there is no neck.
    n_necks : int
        In all trees.
    """

    is_of_maxima: bool
    n_roots: int
    n_features: int
    parent: Ints
    part: Ints
    extremum: Ints
    saddle: Ints
    closing: Ints
    joint_part: Ints
    joint_closing: Ints
    twin: Ints
    neck: Ints
    neck_closing: Ints
    n_necks: int

    @cached_property
    def closing_before(self) -> Ints:
        """(A,) the smallest ``joint_closing`` on the path from the leaf that names the arc to the arc, itself left out.

        ``NEVER`` where no arc is before it.
        """
        before = np.full(len(self.part), NEVER)
        smallest: dict[int, int] = {}
        # A parent has a larger index than its children, so the path from a leaf is met in its order.
        for arc, (part, closing) in enumerate(zip(self.part.tolist(), self.joint_closing.tolist(), strict=True)):
            before[arc] = smallest.get(part, NEVER)
            smallest[part] = min(closing, smallest.get(part, NEVER))
        return before

    @cached_property
    def least_closing_inside(self) -> Ints:
        """(A,) the smallest ``joint_closing`` of all arcs strictly inside each arc's subtree; ``NEVER`` for leaves."""
        least = np.full(len(self.part), NEVER)
        for arc, parent in enumerate(self.parent.tolist()):
            if parent != NO_ARC:
                least[parent] = min(least[parent], least[arc], self.joint_closing[arc])
        return least

    @property
    def is_root(self) -> Bools:
        """Mask (A,) of the arcs that nothing goes on behind."""
        return self.parent == NO_ARC

    @property
    def has_saddle(self) -> Bools:
        """Mask (A,) of the arcs that close at a saddle or a neck: all but roots and whole shells."""
        return self.saddle != NO_SADDLE

    @property
    def is_neck(self) -> Bools:
        """Mask (A,) of the arcs that close at a neck."""
        return self.neck != NO_NECK

    @property
    def has_pair(self) -> Bools:
        """Mask (A,) of the arcs that close at the saddle of a pair, and so from some level on."""
        return (self.closing != ALWAYS) & (self.closing < NEVER)

    @cached_property
    def is_shell(self) -> Bools:
        """Mask (A,) of the arcs that are whole shells beside the first; they are parts at every level."""
        return ~self.has_saddle & (self.closing == ALWAYS)

    @cached_property
    def shell(self) -> Ints:
        """(A,) the arc of the whole shell that each arc lies on; the root for the first shell."""
        number = np.arange(len(self.parent))
        return self.spread(np.where(self.is_shell | self.is_root, number + 1, 0)) - 1

    @property
    def body(self) -> Ints:
        """(A,) the part that is left of each arc's shell when all others are cut off: 0 on the first shell."""
        return np.where(self.is_shell, self.part, 0)[self.shell]

    def is_cut(self, level: int) -> Bools:
        """Mask (A,) of the arcs that belong to a surviving leaf and close at a saddle that survives at ``level``."""
        return (self.joint_closing < level) & (self.joint_part <= self.n_roots + level)

    def is_feature(self, level: int) -> Bools:
        """Mask (A,) of the arcs that are whole parts of a level: the first cut on the path from each surviving leaf."""
        return self.is_cut(level) & (self.closing_before >= level)

    def subtree(self, arc: int) -> Bools:
        """Mask (A,) of the arcs in the part that is cut off at ``arc``, itself included."""
        inside = np.zeros(len(self.parent), dtype=bool)
        inside[arc] = True
        for inner in range(arc - 1, -1, -1):
            inside[inner] = self.parent[inner] != NO_ARC and inside[self.parent[inner]]
        return inside

    def spread(self, part: Ints) -> Ints:
        """Return the parts (A,) of all arcs, given those of the cut ones and 0 elsewhere."""
        part = part.copy()
        for arc in range(len(part) - 1, -1, -1):
            if part[arc] == 0 and self.parent[arc] != NO_ARC:
                part[arc] = part[self.parent[arc]]
        return part


def flat_tree(n_parts: int, is_of_maxima: bool) -> ArcTree:
    """Return a tree of parts that all end at its root: what single borders cut off, and the rest."""
    n_arcs = n_parts + 1
    is_root = np.arange(n_arcs) == n_parts
    part, closing = np.arange(1, n_arcs + 1), np.where(is_root, NEVER, ALWAYS)
    return ArcTree(
        is_of_maxima=is_of_maxima,
        n_roots=n_arcs,
        n_features=0,
        parent=np.where(is_root, NO_ARC, n_parts),
        part=part,
        extremum=np.zeros(n_arcs, dtype=np.int64),
        saddle=np.where(is_root, NO_SADDLE, 0),
        closing=closing,
        joint_part=part,
        joint_closing=closing,
        **without_necks(n_arcs),
    )


def without_necks(n_arcs: int) -> dict[str, Any]:
    """Return the columns of a tree in which no arc closes at a neck, or has a twin."""
    return {
        "twin": np.arange(n_arcs),
        "neck": np.full(n_arcs, NO_NECK),
        "neck_closing": np.full(n_arcs, NEVER),
        "n_necks": 0,
    }
