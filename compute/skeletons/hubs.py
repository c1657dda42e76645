"""Hubs, at which limbs meet. Nodes of the graph that lie within each other's flesh are one."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Floats, Ints
from ..surface.ties import first_least
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
    around = _chains_around(chains)
    alone = [_hub_at(frozenset([node]), around, slices, centres) for node in nodes]
    number = {node: place for place, node in enumerate(nodes)}
    inner = [(number[chain.start], number[chain.end]) for chain in chains if not {chain.start, chain.end} & tips]
    hub = _gathered(alone, np.array(inner, dtype=np.int64).reshape(-1, 2))
    gathered: dict[int, set[int]] = {}
    for node, first in zip(nodes, hub.tolist(), strict=True):
        gathered.setdefault(first, set()).add(node)
    return [_hub_at(frozenset(together), around, slices, centres) for together in gathered.values()]


def _gathered(alone: list[Hub], inner: Ints) -> Ints:
    """Unite the two nearest ends of a chain as long as they are close; return for each node the first of its hub.

    Parameters
    ----------
    alone : list of Hub
        One for each node.
    inner : (E, 2) int64
        The two nodes of each chain between nodes.
    """
    hub = np.arange(len(alone))
    places = np.array([node.places[0] for node in alone]).reshape(-1, 3)
    radius, n_nodes = np.array([node.radius for node in alone]), np.ones(len(alone))
    while True:
        ends = hub[inner]
        ends = np.sort(ends[ends[:, 0] != ends[:, 1]], axis=1)
        distance = np.linalg.norm(places[ends[:, 0]] - places[ends[:, 1]], axis=1)
        closeness = distance / radius[ends].max(axis=1, initial=0)
        if not len(ends) or closeness.min() >= CLOSE:
            return hub
        first, second = ends[first_least(closeness)]
        places[first] = np.average(places[[first, second]], axis=0, weights=n_nodes[[first, second]])
        radius[first], n_nodes[first] = max(radius[first], radius[second]), n_nodes[first] + n_nodes[second]
        hub[hub == second] = first


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
    around = _chains_around(chains)
    return [_hub_at(hub, around, slices, centres) for hub in sorted(set(hub_of.values()), key=min)]


def hub_numbers(hubs: Sequence[Hub]) -> dict[int, int]:
    """Return the number of the hub that each node belongs to; tips belong to none."""
    return {node: number for number, hub in enumerate(hubs) for node in hub.nodes}


def _chains_around(chains: list[Chain]) -> dict[int, list[Chain]]:
    """Return the chains that begin or end at each node, in their order."""
    around: dict[int, list[Chain]] = {}
    for chain in chains:
        for node in {chain.start, chain.end}:
            around.setdefault(node, []).append(chain)
    return around


def _hub_at(nodes: frozenset[int], around: dict[int, list[Chain]], slices: Slices, centres: Floats) -> Hub:
    """Return a hub in the middle of the level sets that lead away from some nodes, wide ones counting more."""
    touching = [chain for node in sorted(nodes) for chain in around[node]]
    # Chains between the nodes lie askew; a ring at a single node has two ends there.
    leaving = [chain for chain in touching if chain.start == chain.end or not {chain.start, chain.end} <= nodes]
    leaving = leaving or touching
    starts = [chain.slices[0] for chain in leaving if chain.start in nodes]
    ends: Ints = np.array(starts + [chain.slices[-1] for chain in leaving if chain.end in nodes], dtype=np.int64)
    girth = slices.girth[ends]
    places = np.einsum("s,psd->pd", girth, centres[:, ends]) / girth.sum()
    return Hub(nodes, places, float(slices.radius[ends].max()))
