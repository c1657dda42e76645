"""The pattern of a skeleton's bones in terms of parts, so that a registered shape can be given the same bones."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..analysis.analysis import Analysis
from ..surface.mesh import Floats, Ints
from .branching import Chain
from .hubs import Hub, hub_numbers
from .limbs import Trace, lay_limb
from .slices import Slices

Tips = frozenset[int]


@dataclass(frozen=True, eq=False)
class LimbLayout:
    """The bones along one limb.

    Attributes
    ----------
    joints : tuple of float
        Share of the limb's length at which each joint lies, from 0 to 1.
    borders : tuple of float
        Share of the length at which the limb passes into another part.
    parts : tuple of int
        Each bone lies in.
    has_carrier : bool
        Whether the first bone lies in the hub's part and carries the limb.
    """

    joints: tuple[float, ...]
    borders: tuple[float, ...]
    parts: tuple[int, ...]
    has_carrier: bool


@dataclass(frozen=True, eq=False)
class BoneLayout:
    """The bones of a skeleton without loops, wherever they lie.

    A limb is known by the parts whose tips lie beyond it, seen from the root.

    Attributes
    ----------
    parts : frozenset of int
        All parts there were, those without bones included.
    root : frozenset of frozenset of int
        The tips beyond each limb that begins at the root.
    limbs : mapping of frozenset of int to LimbLayout
    """

    parts: Tips
    root: frozenset[Tips]
    limbs: Mapping[Tips, LimbLayout]

    @property
    def tips(self) -> Tips:
        """Parts in which limbs end."""
        return frozenset().union(*self.limbs)

    def is_split(self, sides: tuple[Tips, Tips]) -> bool:
        """Whether a limb stands between two groups of tips; only those known on both shapes count."""
        present = sides[0] | sides[1]
        return any({limb & present, present - limb} == set(sides) for limb in self.limbs)


def layout_of(
    traces: list[Trace], sides: list[tuple[Tips, Tips]], root: int, labels: NDArray[np.int32], slices: Slices
) -> BoneLayout:
    """Return the layout of traced limbs, given the tips on both sides of each, and the number of the root's hub."""
    limbs = {beyond: _layout_of_limb(trace, slices) for trace, (_, beyond) in zip(traces, sides, strict=True)}
    at_root = [beyond for trace, (_, beyond) in zip(traces, sides, strict=True) if trace.ends.start == root]
    return BoneLayout(frozenset(np.unique(labels).tolist()), frozenset(at_root), limbs)


def _layout_of_limb(trace: Trace, slices: Slices) -> LimbLayout:
    last = len(trace.curve.along) - 1
    joints, borders = (tuple((points / last).tolist()) for points in (trace.joints, trace.borders))
    return LimbLayout(joints, borders, tuple(lay_limb(trace, slices).part.tolist()), trace.has_carrier)


def tips_on_sides(
    chains: list[Chain], part_of_tip: Mapping[int, int], hubs: Sequence[Hub] = ()
) -> list[tuple[Tips, Tips]]:
    """Return the parts whose tips lie before the start and beyond the end of each chain of a tree.

    The nodes of a hub are one place.
    """
    place = {node: ~number for node, number in hub_numbers(hubs).items()}
    ends = [(place.get(chain.start, chain.start), place.get(chain.end, chain.end)) for chain in chains]
    around: dict[int, list[tuple[int, int]]] = {}
    for row, (start, end) in enumerate(ends):
        around.setdefault(start, []).append((row, end))
        around.setdefault(end, []).append((row, start))
    return [
        (_tips_from(start, row, around, part_of_tip), _tips_from(end, row, around, part_of_tip))
        for row, (start, end) in enumerate(ends)
    ]


def _tips_from(
    place: int, left_out: int, around: Mapping[int, list[tuple[int, int]]], part_of_tip: Mapping[int, int]
) -> Tips:
    """Return the parts of the tips that are reached from a place by all chains but one.

    Parameters
    ----------
    around : mapping of int to list of (int, int)
        For each place the chains that touch it, each with its other end.
    """
    reached, waiting = {place}, [place]
    while waiting:
        beyond = {end for row, end in around[waiting.pop()] if row != left_out} - reached
        reached |= beyond
        waiting.extend(beyond)
    return frozenset(part_of_tip[end] for end in reached if end in part_of_tip)


def level_with_tips(analysis: Analysis, labels: NDArray[np.int32], tips: Tips, level: int) -> int:
    """Return the first level from the given one at which each of some parts has an extremum, where it has any."""
    hierarchy, net, values = analysis.hierarchy, analysis.net, analysis.field.values
    label_of_vertex = np.zeros(len(net.positions), dtype=np.int64)
    label = labels[analysis.surface.input_triangle[net.triangle_of_surface]]
    label_of_vertex[net.triangles.ravel()] = np.repeat(label, 3)
    used = net.used
    always = [used[values[used].argmax()], used[values[used].argmin()]][: 1 + analysis.field.minima_are_features]
    rising = label_of_vertex[hierarchy.pairs[::-1][: hierarchy.n_levels - 1, 0]]
    wanted = np.array(sorted(tips - set(label_of_vertex[always].tolist())), dtype=np.int64)
    present, first = np.unique(rising, return_index=True)
    needed = first[np.isin(present, wanted)] + 1
    return max(level, int(needed.max(initial=0)))


def root_of_layout(layout: BoneLayout, chains: list[Chain], hubs: list[Hub], sides: list[tuple[Tips, Tips]]) -> int:
    """Return the hub that has most of the root's limbs, -1 if none has any."""
    shared: Counter[int] = Counter()
    number = hub_numbers(hubs)
    for chain, (before, beyond) in zip(chains, sides, strict=True):
        for node, tips in ((chain.start, beyond), (chain.end, before)):
            if node in number and tips in layout.root:
                shared[number[node]] += 1
    return max(sorted(shared), key=lambda hub: shared[hub], default=-1)


def with_layout(traces: list[Trace], sides: list[tuple[Tips, Tips]], layout: BoneLayout) -> list[Trace]:
    """Return the traces with the bones of a layout, those of limbs that it does not know as they are."""
    present = frozenset().union(*(before | beyond for before, beyond in sides))
    known = {limb & present: of_limb for limb, of_limb in layout.limbs.items()}
    count = Counter(beyond for _, beyond in sides)
    return [
        _laid_out(trace, known[beyond]) if count[beyond] == 1 and beyond in known else trace
        for trace, (_, beyond) in zip(traces, sides, strict=True)
    ]


def _laid_out(trace: Trace, layout: LimbLayout) -> Trace:
    """Return a trace with joints at the same share of the length between the borders of parts."""
    last = len(trace.curve.along) - 1
    share = np.array(layout.joints)
    borders: Floats = trace.borders / last
    if len(borders) == len(layout.borders):
        share = np.interp(share, [0, *layout.borders, 1], [0, *borders, 1])
    joints = _apart(np.round(share * last).astype(np.int64), last)
    return replace(trace, joints=joints, has_carrier=layout.has_carrier, parts=np.array(layout.parts))


def _apart(joints: Ints, last: int) -> Ints:
    """Return points that rise from 0 to the last one, each higher than the one before."""
    number = np.arange(len(joints))
    rising = np.maximum.accumulate(joints - number) + number
    return np.minimum(rising, last - number[::-1])
