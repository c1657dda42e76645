"""Necks: where limbs narrow on both sides, such as wrists, ankles, elbows and knees."""

from dataclasses import dataclass

import numpy as np

from ...fields.scalar_field import ScalarField
from ...surface.mesh import Floats, Ints
from ...surface.ties import first_least
from .arc_tree import ArcTree
from .limbs import Limb, find_limbs

# A neck is a joint at the default level if it is narrower than this fraction of the limb's widest places on both sides.
NARROW = 0.82
# And if it cuts off at least this fraction of the area of the whole.
LEAST_AREA = 0.02
# What is less of a neck than this is a ripple of the surface.
RIPPLE = 0.995
# On both sides of a neck lies at least this fraction of the limb.
LEAST_SIDE = 0.08
# What a neck cuts off is slender: the length² of the neck over the area is below this. A cylinder closed at its end has
# that if it is 1.3 times as long as it is thick.
SLENDER = 2.0
# Even places along a limb at which its width is compared, and rounds in which it is smoothed over neighbouring places.
N_PLACES = 128
N_ROUNDS = 2


@dataclass(frozen=True, eq=False)
class Necks:
    """The necks of a tree, k of them.

    Attributes
    ----------
    arc : (k,) int64
        The arc that each lies on.
    vertex : (k,) int64
        A net vertex on that arc and nearest to the level set of the neck.
    strength : (k,) float64
        1 for what is just a joint at the default level, more for what is narrower, less for what is wider or smaller.
    limb : (k,) int64
        The arc at which the limb ends.
    twin : (k,) int64
        The place of the neck that a symmetry maps each onto; its own where there is none.
    """

    arc: Ints
    vertex: Ints
    strength: Floats
    limb: Ints
    twin: Ints


@dataclass(frozen=True)
class _Neck:
    """One neck, with the height of its vertex."""

    arc: int
    vertex: int
    height: float
    strength: float
    limb: int


def find_necks(tree: ArcTree, arc: Ints, field: ScalarField, default_level: int) -> Necks:
    """Return the necks of the limbs of a tree; twins have theirs at the same places, or both have none.

    Parameters
    ----------
    tree : ArcTree
    arc : (n,) int64
        Arc of each vertex of the field's net.
    field : ScalarField
    default_level : int
    """
    rising = -field.values if tree.is_of_maxima else field.values
    limbs = {limb.end: limb for limb in find_limbs(tree, arc, field, default_level)}
    rows: list[_Neck] = []
    twin: list[int] = []
    for end, limb in limbs.items():
        other = limbs.get(int(tree.twin[end]), limb)
        pair = (limb,) if other is limb else (limb, other)
        for place, strength in _necks_of(pair) if other.end >= end else []:
            made = [_neck_at(one, place, strength, tree, arc, rising) for one in pair]
            known = {(neck.arc, neck.height) for neck in rows}
            new = [neck for neck in made if neck is not None and (neck.arc, neck.height) not in known]
            # Both twins or none.
            if len(new) == len(pair):
                twin += range(len(rows) + len(new) - 1, len(rows) - 1, -1)
                rows += new
    return Necks(
        arc=np.array([neck.arc for neck in rows], dtype=np.int64),
        vertex=np.array([neck.vertex for neck in rows], dtype=np.int64),
        strength=np.array([neck.strength for neck in rows], dtype=np.float64),
        limb=np.array([neck.limb for neck in rows], dtype=np.int64),
        twin=np.array(twin, dtype=np.int64),
    )


def _necks_of(limbs: tuple[Limb, ...]) -> list[tuple[float, float]]:
    """Return (place along the limb, strength) of each neck that some limbs have in common, the strongest first."""
    places = (np.arange(N_PLACES) + 0.5) / N_PLACES
    width = np.exp(np.mean([np.log(_widths(limb, places)) for limb in limbs], axis=0))
    inside = np.mean([np.interp(places, limb.along, limb.inside) for limb in limbs], axis=0)
    area, share = (np.mean([getattr(limb, name) for limb in limbs]) for name in ("area", "share"))
    narrow = _narrowness(width)
    is_slender = width**2 < SLENDER * np.maximum(inside, LEAST_SIDE) * area
    is_neck = (narrow < RIPPLE) & (inside > LEAST_SIDE) & (inside < 1 - LEAST_SIDE) & is_slender
    strength = np.minimum(np.sqrt((1 - narrow) / (1 - NARROW)), inside * share / LEAST_AREA)
    found = np.flatnonzero(is_neck)[np.argsort(-strength[is_neck], kind="stable")]
    return list(zip(places[found].tolist(), strength[found].tolist(), strict=True))


def _widths(limb: Limb, places: Floats) -> Floats:
    """Return the lengths of the level sets at some places along a limb, smoothed."""
    known = limb.length > 0
    width = np.interp(places, limb.along[known], limb.length[known])
    for _ in range(N_ROUNDS):
        wide = np.pad(width, 1, mode="edge")
        width = (wide[:-2] + 2 * wide[1:-1] + wide[2:]) / 4
    return width


def _narrowness(width: Floats) -> Floats:
    """Return each local minimum over the lesser of the two widest places beside it; 1 for all else.

    What lies beside it ends where the limb is narrower still.
    """
    narrow = np.ones(len(width))
    for place in np.flatnonzero((width[1:-1] < width[:-2]) & (width[1:-1] <= width[2:])) + 1:
        sides = width[:place][::-1], width[place + 1 :]
        narrow[place] = width[place] / min(_widest(side, width[place]) for side in sides)
    return narrow


def _widest(side: Floats, least: float) -> float:
    """Return the largest of some widths up to the first that is below the least."""
    below = np.flatnonzero(side < least)
    return float(side[: below[0] if len(below) else None].max(initial=least))


def _neck_at(limb: Limb, place: float, strength: float, tree: ArcTree, arc: Ints, rising: Floats) -> _Neck | None:
    """Return a neck of a limb, at the vertex that is nearest to its level set; None if nothing lies beyond that."""
    height = np.interp(place, limb.along, limb.height)
    chosen = int(limb.arc[min(int(np.searchsorted(limb.height, height)), len(limb.arc) - 1)])
    on_arc = np.flatnonzero(arc == chosen)
    is_leaf = not (tree.parent == chosen).any()
    beyond = float(rising[on_arc].min(initial=np.inf)) if is_leaf else -np.inf
    candidates = on_arc[rising[on_arc] > beyond]
    if not len(candidates):
        return None
    vertex = int(candidates[first_least(np.abs(rising[candidates] - height))])
    return _Neck(chosen, vertex, float(rising[vertex]), strength, limb.end)
