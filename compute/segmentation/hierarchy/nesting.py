"""Levels overlaid: the cuts between features that are worth a part of their own."""

import numpy as np

from ...surface.mesh import Bools, Floats, Ints, sum_by
from ...surface.ties import first_largest, first_least
from .arc_measures import LEAST_HEIGHT, ArcMeasures
from .arc_tree import ALWAYS, NO_ARC, ArcTree

# An inner part is worth keeping if its border is a neck: shorter than this fraction of the longest level sets on its
# two sides (their geometric mean).
NECK = 0.81
# And if it has at least this fraction of the area of the whole.
LEAST_AREA = 0.05
# A feature is worth a part if its roundness is below this: the least length²/area of its level sets, area being what
# they cut off, its tip left out. A hemisphere has 2 pi, a hemisphere on a cylinder half as high as its radius 4.2.
BLUNT = 4.4
# Two features that leave less than this share of the area between them are the two ends of one thing, as of a rod or an
# egg, unless where they meet is shorter than the second share of the longest level sets of both, or than the third of
# one of them while neither is blunt (a ball on a stick).
BELT, WAIST, SHOULDER = 0.2, 0.9, 0.5
# A joint is left out where it would cut off less than this share of the area, or leave less up to the next cut.
LEAST_PIECE = 0.003
# Beyond the default level, who asks for more features gets all whose roundness is less than that of a hemisphere.
HEMISPHERE = 2 * np.pi


def nested_cuts(
    tree: ArcTree, measures: ArcMeasures, area: Floats, *, level: int, default_level: int, has_ends: bool
) -> Bools:
    """Mask (A,) of the arcs that end a part when all levels up to ``level`` are overlaid.

    Up to the default level every feature is cut off unless it is blunt, and so is what lies between two of its saddles
    (the torso between arms and legs), unless it is a thin shell or no neck shows where it ends. Beyond the default
    level these parts stay, and smaller ones are cut off inside them (fingers in an arm) unless they are flat.

    Parameters
    ----------
    tree : ArcTree
    measures : ArcMeasures
        Of its arcs.
    area : (A,) float64
        Share of each arc in the area of its shell.
    level : int
    default_level : int
        Of the hierarchy.
    has_ends : bool
        Whether two features may be only the two ends of one thing. Those of a field with minima as features are not:
        there the middle counts, too.
    """
    candidates = tree.is_cut(min(level, default_level)) & ~tree.is_shell
    is_cut = _worthy_cuts(tree, measures, area, candidates)
    if has_ends:
        is_cut[_two_ends(tree, measures, area, candidates)] = False
    is_finer = tree.is_cut(level) & (tree.joint_closing >= default_level)
    was_feature = tree.least_closing_inside > tree.joint_closing
    return is_cut | tree.is_shell | (is_finer & was_feature & (measures.roundness < HEMISPHERE))


def joint_cuts(
    tree: ArcTree,
    measures: ArcMeasures,
    area: Floats,
    is_cut: Bools,
    *,
    level: int,
    default_level: int,
    has_ends: bool,
) -> Bools:
    """Mask (A,) of the arcs that end at a joint of a level.

    They are at the necks of the limbs that are cut off, and of the two ends of a thing that is not cut between them.

    Parameters
    ----------
    tree : ArcTree
    measures : ArcMeasures
        Of its arcs.
    area : (A,) float64
        Share of each arc in the area of its shell.
    is_cut : (A,) bool
        The arcs that end a part without joints.
    level : int
    default_level : int
        Of the hierarchy, whose features are the limbs.
    has_ends : bool
        As for ``nested_cuts``.
    """
    is_limb, in_limb = tree.is_feature(default_level), np.zeros(len(is_cut), dtype=bool)
    is_end = is_cut.copy()
    if has_ends:
        is_end[_two_ends(tree, measures, area, tree.is_cut(default_level) & ~tree.is_shell)] = True
    for arc in range(len(is_cut) - 1, -1, -1):
        parent = tree.parent[arc]
        in_limb[arc] = is_end[arc] if is_limb[arc] else parent != NO_ARC and in_limb[parent]
    return _without_slivers(tree, area, is_cut, in_limb & (tree.neck_closing < level))


def _without_slivers(tree: ArcTree, area: Floats, is_cut: Bools, is_joint: Bools) -> Bools:
    """Leave out joints that lie so near to another cut that next to nothing is between them."""
    kept = is_joint.copy()
    while True:
        region = tree.spread(np.where(is_cut | kept | tree.is_shell, np.arange(1, len(area) + 1), 0))
        size = sum_by(region, area, len(area) + 1)
        joints = np.flatnonzero(kept)
        between = np.minimum(size[joints + 1], size[region[tree.parent[joints]]])
        if not (between < LEAST_PIECE).any():
            return kept
        left_out = joints[first_least(between)]
        # Twins are cut at both joints or at none.
        kept[[left_out, tree.twin[left_out]]] = False


def numbered(tree: ArcTree, is_cut: Bools) -> Ints:
    """Return the number (A,) of the part that is cut off at each arc, 0 where nothing is.

    The outermost on the path from a leaf has the leaf's number, so that an arm stays the same part when its fingers
    appear; the others have numbers of their own, beyond those of the leaves.
    """
    # Numbers of leaves are followed by those of inner parts between maxima, then between minima, then of joints, then
    # of saddles that survive always.
    first = 1 + tree.n_roots + tree.n_features * (1 if tree.is_of_maxima else 2)
    own = np.where(tree.is_neck, first_own_part(tree) - tree.n_necks + tree.neck, first + tree.closing)
    own = np.where(tree.closing == ALWAYS, first_own_part(tree) + np.arange(len(is_cut)), own)
    number = np.zeros(len(is_cut), dtype=np.int64)
    seen: set[int] = set()
    for arc in np.flatnonzero(is_cut)[::-1].tolist():
        part = int(tree.part[arc])
        number[arc] = own[arc] if part in seen else part
        seen.add(part)
    return number


def first_own_part(tree: ArcTree) -> int:
    """Return the least number that no part of any level has."""
    return number_behind(tree.n_roots, tree.n_features, tree.n_necks)


def number_behind(n_roots: int, n_features: int, n_necks: int) -> int:
    """Return the number that follows those of leaves, of inner parts and of joints of two trees."""
    return 1 + n_roots + 3 * n_features + n_necks


def _worthy_cuts(tree: ArcTree, measures: ArcMeasures, area: Floats, candidates: Bools) -> Bools:
    """Mask (A,) of the cut arcs that end something that is worth a part."""
    is_cut = candidates.copy()
    height, longest, inside = measures.height.copy(), measures.longest.copy(), area.copy()
    border = measures.closing_length.copy()
    has_cut_inside = np.zeros(len(area), dtype=bool)
    last: dict[int, int] = {}
    for parent, meeting in _meeting_arcs(tree.parent):
        for arc in meeting:
            # What has gathered on the path from the last cut.
            previous = last.get(int(tree.part[arc]))
            if previous is not None and not is_cut[previous]:
                height[arc] += height[previous]
                longest[arc] = max(longest[arc], longest[previous])
                inside[arc] += inside[previous]
                # A thin shell was not measured; it ends nearly where it begins.
                border[arc] = border[arc] or border[previous]
            last[int(tree.part[arc])] = arc
        for arc in [arc for arc in meeting if is_cut[arc]]:
            if has_cut_inside[arc]:
                is_neck = _narrowing(border, longest, arc, meeting) < NECK
                is_cut[arc] = is_neck and height[arc] > LEAST_HEIGHT and inside[arc] > LEAST_AREA
            else:
                is_cut[arc] = measures.roundness[arc] < BLUNT
        has_cut_inside[parent] = (has_cut_inside | is_cut)[meeting].any()
    return _with_a_body(tree, is_cut, is_cut & has_cut_inside, area)


def _two_ends(tree: ArcTree, measures: ArcMeasures, area: Floats, candidates: Bools) -> list[int]:
    """Return the arcs of features that are only the two ends of their shell: nothing tells where to cut it."""
    shell = tree.spread(np.where(tree.is_shell, np.arange(1, len(area) + 1), 0))
    found: list[int] = []
    for number in np.unique(shell[candidates]).tolist():
        ends = np.flatnonzero(candidates & (shell == number)).tolist()
        if len(ends) != 2 or tree.parent[ends[0]] != tree.parent[ends[1]]:
            continue
        outside = area[(shell == number) & ~(tree.subtree(ends[0]) | tree.subtree(ends[1]))].sum()
        shares = measures.closing_length[ends] / np.maximum(measures.widest[ends], np.finfo(float).tiny)
        has_waist = (shares < WAIST).all()
        has_shoulder = (shares < SHOULDER).any() and (measures.roundness[ends] < BLUNT).all()
        if outside < BELT and not has_waist and not has_shoulder:
            found += ends
    return found


def _meeting_arcs(parent: Ints) -> list[tuple[int, list[int]]]:
    """Return each arc that others end at, with these; whatever is inside comes before."""
    meeting: dict[int, list[int]] = {}
    for arc, end in enumerate(parent.tolist()):
        if end != NO_ARC:
            meeting.setdefault(end, []).append(arc)
    return sorted(meeting.items())


def _narrowing(border: Floats, longest: Floats, arc: int, meeting: list[int]) -> float:
    """Return the border of an arc where it meets others over the longest level sets on both sides; 1 for a cylinder."""
    shares = {other: border[other] / longest[other] if border[other] else 1.0 for other in meeting}
    beyond = min((share for other, share in shares.items() if other != arc), default=1.0)
    return float(np.sqrt(shares[arc] * beyond))


def _with_a_body(tree: ArcTree, is_cut: Bools, is_inner: Bools, area: Floats) -> Bools:
    """Leave the largest inner part to the body if only a belt would be left of it, as at a waist."""
    region = tree.spread(np.where(is_cut | tree.is_shell, np.arange(1, len(area) + 1), 0))
    size = sum_by(region, area, len(area) + 1)
    kept = is_cut.copy()
    for body in (0, *(1 + np.flatnonzero(tree.is_shell))):
        next_to_body = np.flatnonzero(is_inner & (region[tree.parent] == body))
        if size[body] < LEAST_AREA and len(next_to_body):
            kept[next_to_body[first_largest(size[1 + next_to_body])]] = False
    return kept
