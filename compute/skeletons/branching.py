"""The Reeb graph cleared of all that is no limb: chains of slices between hubs and tips."""

from collections import Counter
from dataclasses import dataclass

import numpy as np

from ..msc.reeb import ReebGraph
from ..surface.mesh import Ints
from .slices import Slices


@dataclass(frozen=True, eq=False)
class Chain:
    """The slices between two nodes of the graph, in their order.

    Attributes
    ----------
    start, end : int
        Nodes of the Reeb graph.
    slices : (n,) int64
    """

    start: int
    end: int
    slices: Ints

    def reversed(self) -> "Chain":
        """Return the same from its other end."""
        return Chain(self.end, self.start, self.slices[::-1])


def chains_between(graph: ReebGraph, slices: Slices, tips: set[int]) -> list[Chain]:
    """Return the chains of a Reeb graph from which all leaves but the wanted tips are taken off, again and again.

    Where a chain only passes through a node, it goes on; loops stay.
    """
    stands_for = _joined_by_nothing(graph, slices)
    arcs = [(arc, stands_for[low], stands_for[high]) for arc, (low, high) in enumerate(graph.arcs.tolist())]
    chains = [Chain(low, high, slices.of_arc(arc)) for arc, low, high in arcs if len(slices.of_arc(arc))]
    while True:
        degree = _degrees(chains)
        kept = [chain for chain in chains if all(end in tips or degree[end] > 1 for end in (chain.start, chain.end))]
        if len(kept) == len(chains):
            break
        chains = kept
    for node in sorted(node for node, count in degree.items() if count == 2 and node not in tips):
        chains = _joined_at(chains, node)
    return chains


def _degrees(chains: list[Chain]) -> Counter[int]:
    return Counter(end for chain in chains for end in (chain.start, chain.end))


def _joined_at(chains: list[Chain], node: int) -> list[Chain]:
    """Make one chain of the two that meet at a node; a ring that nothing else touches stays."""
    meeting = [chain for chain in chains if node in (chain.start, chain.end)]
    if len(meeting) != 2:
        return chains
    first, second = meeting
    first = first if first.end == node else first.reversed()
    second = second if second.start == node else second.reversed()
    others = [chain for chain in chains if chain not in meeting]
    return [*others, Chain(first.start, second.end, np.concatenate([first.slices, second.slices]))]


def _joined_by_nothing(graph: ReebGraph, slices: Slices) -> list[int]:
    """Return for each node the one that stands for it: an arc too short for any triangle joins its two ends."""
    node = np.arange(len(graph.vertex))
    for arc in np.flatnonzero(np.diff(slices.offset) == 0).tolist():
        low, high = node[graph.arcs[arc]]
        node[node == high] = low
    return node.tolist()
