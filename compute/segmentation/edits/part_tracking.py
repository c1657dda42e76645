"""Parts found again after another analysis of the same mesh: where most of their faces are the same."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...surface.mesh import Bools, Floats, Ints, sum_by
from ..faces.part_tree import PartTree
from ..hierarchy.arc_tree import NO_ARC
from ..hierarchy.levels import Hierarchy
from ..hierarchy.nesting import first_own_part
from .corrections import LEVEL, MERGE, PAINT, SPLIT, Correction

# A part is the same if what is in both has at least this share of what is in either.
SAME = 0.5
# Levels that a part is sought on.
MOST_LEVELS = 64


@dataclass(frozen=True)
class Place:
    """The number of a tree, the arc of it at which a part is cut off, and the level on which it is."""

    tree: int
    arc: int
    level: int


def place_of(
    part_tree: PartTree, part: int, level: int, mode: str, branch_levels: tuple[tuple[int, int], ...]
) -> Place:
    """Return the arc at which a part is cut off on a level.

    Raises
    ------
    LookupError
        If the level has no such part.
    """
    level = min(level, part_tree.hierarchy.n_levels - 1)
    for tree, cut in enumerate(part_tree.cut_arcs(level, mode, branch_levels)):
        for arc in np.flatnonzero(cut == part).tolist():
            return Place(tree, arc, level)
    raise LookupError(part)


def carried(items: tuple[Correction, ...], old: PartTree, new: PartTree, area: Floats) -> dict[int, tuple[int, int]]:
    """Return for each part that corrections mention the (number, level) it has in another analysis, if it is there.

    Numbers that corrections gave to parts of their own are numbered on from the last one of the new analysis.

    Parameters
    ----------
    items : tuple of Correction
    old, new : PartTree
        Of two analyses of a mesh.
    area : (F,) float64
        Of its faces.
    """
    tracked = {0: (0, 0)}
    first_own = first_own_part(old.trees[0])
    shift = first_own_part(new.trees[0]) - first_own
    for mode in sorted({item.mode for item in items}):
        candidates = _candidates(new, mode)
        for item in items:
            if item.mode != mode:
                continue
            for part in _mentioned(item):
                if part >= first_own:
                    tracked[part] = (part + shift, item.level)
                elif part not in tracked:
                    same = _same_part(_inside(old, part, item, items), new, area, candidates)
                    tracked |= {} if same is None else {part: same}
    return tracked


def tracked_parts(parts: Iterable[int], old: PartTree, new: PartTree, area: Floats, mode: str) -> dict[int, int]:
    """Return the number that each of some parts has in another analysis of the same faces, as far as it is found there.

    Parameters
    ----------
    parts : iterable of int
        Numbers in the old analysis.
    old, new : PartTree
        Of two analyses of a mesh.
    area : (F,) float64
        Of its faces.
    mode : "nested" or "features"
        The mode in which levels are read.
    """
    places: dict[int, tuple[int, int]] = {}
    for place, (number, _) in _candidates(old, mode).items():
        # A number is that of the place where the default level has it, though others may have it elsewhere.
        places.setdefault(number, place)
    candidates = _candidates(new, mode)
    shift = first_own_part(new.trees[0]) - first_own_part(old.trees[0])
    tracked = {0: 0}
    for part in sorted(parts):
        if part >= first_own_part(old.trees[0]):
            tracked[part] = part + shift
        elif part in places:
            same = _same_part(old.faces_inside(*places[part]), new, area, candidates)
            if same is not None and same[0] not in tracked.values():
                tracked[part] = same[0]
    return tracked


def tracked_pieces(pieces: Iterable[int], old: PartTree, new: PartTree, area: Floats, mode: str) -> dict[int, int]:
    """Return what each of some pieces is in another analysis of the same faces, as far as it is found there.

    Parameters
    ----------
    pieces : iterable of int
        Places of arcs among those of all trees of the old analysis.
    old, new : PartTree
        Of two analyses of a mesh.
    area : (F,) float64
        Of its faces.
    mode : "nested", "features" or "jointed"
        How levels are read.
    """
    before = np.cumsum([0, *(len(tree.parent) for tree in new.trees)])
    candidates = {
        (tree, arc): (int(before[tree]) + arc, level) for (tree, arc), (_, level) in _candidates(new, mode).items()
    }
    tracked: dict[int, int] = {}
    for piece in sorted(pieces):
        try:
            same = _same_part(old.faces_of_piece(piece), new, area, candidates)
        except LookupError:
            same = None
        if same is not None and same[0] not in tracked.values():
            tracked[piece] = same[0]
    return tracked


def renumbered(
    items: tuple[Correction, ...], tracked: dict[int, tuple[int, int]], old: Hierarchy, new: Hierarchy
) -> tuple[Correction, ...]:
    """Return the corrections whose parts were all found, with their new numbers and levels."""
    return tuple(
        replace(
            item,
            part=tracked[item.part][0],
            other=tracked[item.other][0] if item.kind in (MERGE, SPLIT) else item.other,
            value=same_level(int(item.value), old, new) if item.kind == LEVEL else item.value,
            level=tracked[item.part][1] or item.level,
        )
        for item in items
        if all(part in tracked for part in _mentioned(item))
    )


def same_level(level: int, old: Hierarchy, new: Hierarchy) -> int:
    """Return the level of a hierarchy that keeps what is as persistent as what a level of another one keeps."""
    falling = np.append(old.persistence[::-1], 0.0)
    if level <= 0 or old.value_range == 0:
        return 0
    kept, dropped = falling[min(level, len(falling) - 1) - 1], falling[min(level, len(falling) - 1)]
    return new.level_of_threshold(float(kept + dropped) / (2 * old.value_range))


def _mentioned(item: Correction) -> tuple[int, ...]:
    return (item.part, item.other) if item.kind in (MERGE, SPLIT) else (item.part,)


def _inside(old: PartTree, part: int, item: Correction, items: tuple[Correction, ...]) -> Bools:
    """Mask (F,) of the faces in a part as it was when a correction was made; empty if it cannot be found."""
    branch_levels = tuple((other.part, int(other.value)) for other in items if other.kind == LEVEL)
    try:
        place = place_of(old, part, item.level, item.mode, branch_levels)
    except LookupError:
        return np.zeros(old.n_faces, dtype=bool)
    return old.faces_inside(place.tree, place.arc)


def _candidates(new: PartTree, mode: str) -> dict[tuple[int, int], tuple[int, int]]:
    """Return (number, level) for each (tree, arc) at which some level cuts a part off."""
    n_levels, default_level = new.hierarchy.n_levels, new.hierarchy.default_level
    # The default level first, as its numbers are those that are seen first.
    levels = [default_level, *range(1, min(n_levels, MOST_LEVELS)), n_levels - 1]
    candidates: dict[tuple[int, int], tuple[int, int]] = {}
    for level in dict.fromkeys(levels):
        for tree, cut in enumerate(new.cut_arcs(level, mode)):
            for arc in np.flatnonzero(cut).tolist():
                candidates.setdefault((tree, arc), (int(cut[arc]), level))
    return candidates


def _same_part(
    inside: Bools, new: PartTree, area: Floats, candidates: dict[tuple[int, int], tuple[int, int]]
) -> tuple[int, int] | None:
    """Return the (number, level) of the part that has most in common with some faces."""
    best, share = None, SAME
    for number, (tree, of_face) in enumerate(zip(new.trees, new.arcs_of_faces, strict=True)):
        n_arcs = len(tree.parent)
        common = sum_by(of_face[inside], area[inside], n_arcs)
        whole = sum_by(of_face, area, n_arcs)
        for arc, parent in enumerate(tree.parent.tolist()):
            if parent != NO_ARC:
                common[parent] += common[arc]
                whole[parent] += whole[arc]
        either = whole + area[inside].sum() - common
        for (of_tree, arc), named in candidates.items():
            if of_tree == number and common[arc] > share * either[arc]:
                best, share = named, float(common[arc] / either[arc])
    return best


def carried_painting(painted: Ints, items: tuple[Correction, ...], tracked: dict[int, tuple[int, int]]) -> Ints:
    """Return the parts (F,) that faces were painted with, by their new numbers; -1 elsewhere."""
    kept = np.full(len(painted), -1)
    for item in items:
        if item.kind == PAINT and item.part in tracked:
            kept[painted == item.part] = tracked[item.part][0]
    return kept
