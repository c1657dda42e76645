"""The plan of a skeleton: hubs, and the limbs between them and the tips, in their order from the root outward."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..errors import LevelError
from ..segmentation.parts.part_labels import BODY
from ..surface.mesh import Floats
from ..surface.ties import CHOICE, first_largest
from .branching import Chain, chains_between
from .hubs import Hub, gathered_hubs, hub_numbers, joined_hubs
from .layout import BoneLayout, Tips, root_of_layout, tips_on_sides
from .limbs import Ends
from .sliced_shape import SlicedShape
from .slices import Slices
from .tips import Tip, tip_of_chain, tips_of_parts, with_straight_tips

NO_LIMBS = "The parts of this level are too short for bones; choose another level."
# The hub in the middle of a shape that has only two ends: no node of the graph.
MIDDLE = -1


@dataclass(frozen=True, eq=False)
class PlannedLimb:
    """A limb before it has joints.

    Attributes
    ----------
    chain : Chain
        From the end nearer to the root.
    ends : Ends
    sides : pair of Tips
        The parts whose tips lie before its start and beyond its end.
    closes_loop : bool
        Whether it ends in a hub that other limbs have reached before.
    """

    chain: Chain
    ends: Ends
    sides: tuple[Tips, Tips]
    closes_loop: bool


@dataclass(frozen=True, eq=False)
class LimbPlan:
    """Limbs in their order from the root outward.

    Attributes
    ----------
    hubs : list of Hub
    root : int
        Number of the hub that all starts from.
    root_part : int
        The part this hub lies in.
    limbs : list of PlannedLimb
    centres : (P, S, 3) float64
        Of the slices in each pose, straight beyond the last slice that leads to a tip.
    """

    hubs: list[Hub]
    root: int
    root_part: int
    limbs: list[PlannedLimb]
    centres: Floats


def plan_limbs(shape: SlicedShape, layout: BoneLayout | None) -> LimbPlan:
    """Return the limbs of a shape, those of a layout where one is given.

    Raises
    ------
    LevelError
        If all parts are too short for bones.
    """
    part_of_tip = tips_of_parts(shape.analysis, shape.graph, shape.slices, layout)
    bare = chains_between(shape.graph, shape.slices, set(part_of_tip))
    hubs = _hubs(bare, part_of_tip, shape, layout)
    chains, hubs = _with_middle(bare, hubs, set(part_of_tip), shape)
    if not chains:
        raise LevelError(NO_LIMBS)
    root = _root(chains, hubs, part_of_tip, shape.slices, layout)
    outward, closes_loop = _from_root(chains, hubs, root)
    parts = [_part_of_hub(hub, shape) for hub in hubs]
    number = hub_numbers(hubs)
    tips = {chain: tip_of_chain(chain, shape) for chain in outward if chain.end not in number}
    ends = [_ends(chain, number, hubs, parts, tips) for chain in outward]
    sides = tips_on_sides(outward, part_of_tip, hubs)
    limbs = [PlannedLimb(*limb) for limb in zip(outward, ends, sides, closes_loop, strict=True)]
    centres = with_straight_tips(shape.centres, tips)
    return LimbPlan(hubs=hubs, root=root, root_part=parts[root], limbs=limbs, centres=centres)


def _hubs(chains: list[Chain], part_of_tip: dict[int, int], shape: SlicedShape, layout: BoneLayout | None) -> list[Hub]:
    """Return the hubs: of a known layout those that lie between its limbs, else nodes that lie close together."""
    if layout is None:
        return gathered_hubs(chains, set(part_of_tip), shape.slices, shape.centres)
    nodes = {end for chain in chains for end in (chain.start, chain.end)} - set(part_of_tip)
    sides = zip(chains, tips_on_sides(chains, part_of_tip), strict=True)
    joints = [chain for chain, both in sides if {chain.start, chain.end} <= nodes and not layout.is_split(both)]
    return joined_hubs(nodes, joints, chains, shape.slices, shape.centres)


def _with_middle(
    chains: list[Chain], hubs: list[Hub], tips: set[int], shape: SlicedShape
) -> tuple[list[Chain], list[Hub]]:
    """Return chains and hubs; a single chain from tip to tip is given a hub in its middle."""
    if not hubs and len(chains) == 1:
        (chain,) = chains
        length = np.cumsum(shape.slices.length[chain.slices])
        half = min(int(np.searchsorted(length, (0.5 - CHOICE) * length[-1])), len(length) - 1)
        middle = chain.slices[half]
        hubs = [Hub(frozenset([MIDDLE]), shape.centres[:, middle], float(shape.slices.radius[middle]))]
        chains = [
            Chain(MIDDLE, chain.start, chain.slices[: half + 1][::-1]),
            Chain(MIDDLE, chain.end, chain.slices[half:]),
        ]
    number = hub_numbers(hubs)
    return [_outward(chain, tips) for chain in chains if not _is_inside(chain, number)], hubs


def _outward(chain: Chain, tips: set[int]) -> Chain:
    return chain.reversed() if chain.start in tips else chain


def _is_inside(chain: Chain, number: Mapping[int, int]) -> bool:
    """Whether a chain was gathered into a hub, given those of nodes; a loop of its own at a node was not."""
    start, end = number.get(chain.start, -1), number.get(chain.end, -1)
    return start == end >= 0 and chain.start != chain.end


def _root(
    chains: list[Chain], hubs: list[Hub], part_of_tip: dict[int, int], slices: Slices, layout: BoneLayout | None
) -> int:
    """Return the hub that has most of the limbs at a layout's root; without one, the hips."""
    if layout is not None:
        known = root_of_layout(layout, chains, hubs, tips_on_sides(chains, part_of_tip, hubs))
        if known >= 0:
            return known
    return _hips(chains, hubs, slices)


def _hips(chains: list[Chain], hubs: list[Hub], slices: Slices) -> int:
    """Return the hub farthest from the bluntest limb: the hips, as that limb is the head in most cases."""
    number = hub_numbers(hubs)
    free = [chain for chain in chains if chain.end not in number] or chains[:1]
    bluntness = [np.median(slices.radius[chain.slices]) / slices.length[chain.slices].sum() for chain in free]
    blunt = free[first_largest(np.array(bluntness))]
    head = hubs[number.get(blunt.start, -1)].places[0]
    return int(first_largest(np.array([np.linalg.norm(hub.places[0] - head) for hub in hubs])))


def _part_of_hub(hub: Hub, shape: SlicedShape) -> int:
    """Return the part that the widest of the level sets below a hub lies in; parts that grow out of it lie above."""
    slices, arcs = shape.slices, enumerate(shape.graph.arcs.tolist())
    below = [slices.of_arc(arc) for arc, (low, high) in arcs if high in hub.nodes and low not in hub.nodes]
    tops = [int(of_arc[-1]) for of_arc in below if len(of_arc)]
    return int(slices.part[tops[first_largest(slices.girth[tops])]]) if tops else BODY


def _from_root(chains: list[Chain], hubs: list[Hub], root: int) -> tuple[list[Chain], list[bool]]:
    """Return the chains in the order in which they are met from the root, and whether each closes a loop.

    Each chain begins at its inner end.
    """
    reached, waiting, left = {root}, [root], list(chains)
    number = hub_numbers(hubs)
    order: list[Chain] = []
    closes_loop: list[bool] = []
    while waiting:
        hub = waiting.pop(0)
        for chain in [chain for chain in left if hub in (number.get(chain.start), number.get(chain.end))]:
            left.remove(chain)
            order.append(chain if number.get(chain.start) == hub else chain.reversed())
            end = number.get(order[-1].end, -1)
            closes_loop.append(end in reached)
            if end >= 0 and end not in reached:
                reached.add(end)
                waiting.append(end)
    return order, closes_loop


def _ends(
    chain: Chain, number: Mapping[int, int], hubs: list[Hub], parts: list[int], tips: Mapping[Chain, Tip]
) -> Ends:
    """Return the ends of a chain, given the hubs of nodes, the parts of hubs and the tips of chains."""
    start, end = number[chain.start], number.get(chain.end, -1)
    places = hubs[end].places if end >= 0 else tips[chain].places
    part = parts[end] if end >= 0 else -1
    return Ends(start, end, np.stack([hubs[start].places, places], axis=1), (parts[start], part))
