"""Hubs: where limbs meet. Nodes of the graph that lie within each other's flesh are one."""

from dataclasses import dataclass

import numpy as np

from ..mesh import Floats, Ints
from .branching import Chain
from .slices import Slices

# Nodes nearer to each other than this many radii of the thicker one are one hub.
CLOSE = 1.0


@dataclass(frozen=True, eq=False)
class Hub:
    """A place where limbs meet.

    Attributes
    ----------
    nodes : frozenset of int
        Nodes of the Reeb graph it stands for.
    places : (P, 3) float64
        In each pose.
    radius : float
    """

    nodes: frozenset[int]
    places: Floats
    radius: float


def gathered_hubs(chains: list[Chain], tips: set[int], slices: Slices, centres: Floats) -> list[Hub]:
    """Return the hubs of a graph, the nodes of short chains gathered.

    Parameters
    ----------
    chains : list of Chain
    tips : set of int
        Nodes at which limbs end.
    slices : Slices
    centres : (P, S, 3) float64
        Of the slices in each pose.
    """
    nodes = sorted({end for chain in chains for end in (chain.start, chain.end)} - tips)
    hubs = [_hub_at(frozenset([node]), chains, slices, centres) for node in nodes]
    inner = [chain for chain in chains if chain.start not in tips and chain.end not in tips]
    while True:
        pairs = {frozenset(_hub_numbers(hubs, chain)) for chain in inner}
        close = [(_closeness(hubs, *sorted(pair)), sorted(pair)) for pair in pairs if len(pair) == 2]
        if not close or min(close)[0] >= CLOSE:
            return [_hub_at(hub.nodes, chains, slices, centres) for hub in hubs]
        first, second = min(close)[1]
        hubs = [*(hub for i, hub in enumerate(hubs) if i not in (first, second)), _united(hubs[first], hubs[second])]


def joined_hubs(
    nodes: set[int], joints: list[Chain], chains: list[Chain], slices: Slices, centres: Floats
) -> list[Hub]:
    """Return the hubs of a graph where it is known which chains lie within one.

    Parameters
    ----------
    nodes : set of int
        All but the tips.
    joints : list of Chain
        Each joins two nodes to one hub.
    chains : list of Chain
        All, those among them.
    slices : Slices
    centres : (P, S, 3) float64
        Of the slices in each pose.
    """
    hub_of = {node: frozenset([node]) for node in nodes}
    for chain in joints:
        united = hub_of[chain.start] | hub_of[chain.end]
        hub_of.update(dict.fromkeys(united, united))
    return [_hub_at(hub, chains, slices, centres) for hub in sorted(set(hub_of.values()), key=min)]


def hub_number(hubs: list[Hub], node: int) -> int:
    """Return the number of the hub that a node belongs to, -1 for a tip."""
    return next((number for number, hub in enumerate(hubs) if node in hub.nodes), -1)


def _hub_numbers(hubs: list[Hub], chain: Chain) -> tuple[int, int]:
    return hub_number(hubs, chain.start), hub_number(hubs, chain.end)


def _hub_at(nodes: frozenset[int], chains: list[Chain], slices: Slices, centres: Floats) -> Hub:
    """Return a hub in the middle of the level sets that lead away from some nodes, wide ones counting more."""
    # Chains between the nodes lie askew; a ring at a single node has two ends there.
    leaving = [chain for chain in chains if chain.start == chain.end or not {chain.start, chain.end} <= nodes]
    leaving = leaving if any(nodes & {chain.start, chain.end} for chain in leaving) else chains
    starts = [chain.slices[0] for chain in leaving if chain.start in nodes]
    ends: Ints = np.array(starts + [chain.slices[-1] for chain in leaving if chain.end in nodes], dtype=np.int64)
    girth = slices.girth[ends]
    places = np.einsum("s,psd->pd", girth, centres[:, ends]) / girth.sum()
    return Hub(nodes, places, float(slices.radius[ends].max()))


def _closeness(hubs: list[Hub], first: int, second: int) -> float:
    distance = np.linalg.norm(hubs[first].places[0] - hubs[second].places[0])
    return float(distance / max(hubs[first].radius, hubs[second].radius))


def _united(first: Hub, second: Hub) -> Hub:
    n_first, n_second = len(first.nodes), len(second.nodes)
    places = (n_first * first.places + n_second * second.places) / (n_first + n_second)
    return Hub(first.nodes | second.nodes, places, max(first.radius, second.radius))
