"""Borders along existing edges: the shortest lines of edges near the borders of given labels."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

from ...surface.mesh import Bools, Floats, Ints
from ..faces.face_graph import FaceGraph

# How many rings of faces a border may move.
N_RINGS = 4
# How much longer an edge counts at the farthest ring than at the border itself.
DRIFT = 0.5
# Capacities of a flow are whole numbers; an edge of mean length has this one.
MEAN_CAPACITY = 1000


def shortened_borders(labels: NDArray[np.int32], graph: FaceGraph) -> NDArray[np.int32]:
    """Return labels (F,) whose borders are as short as they can be within a few rings of faces.

    Parameters
    ----------
    labels : (F,) int32
    graph : FaceGraph
        Of the faces.

    References
    ----------
    .. [1] Boykov, Veksler, Zabih, "Fast Approximate Energy Minimization via Graph Cuts", PAMI 2001: one swap of each
       pair of labels.
    """
    labels = labels.copy()
    ends = labels[graph.neighbours]
    pairs = np.unique(np.sort(ends[ends[:, 0] != ends[:, 1]], axis=1), axis=0)
    for first, second in pairs.tolist():
        _shorten(labels, graph, first, second)
    return labels


def _shorten(labels: NDArray[np.int32], graph: FaceGraph, first: int, second: int) -> None:
    """Move the border between two labels to where it is shortest."""
    is_side = np.isin(labels, [first, second])
    inside = is_side[graph.neighbours].all(axis=1)
    pairs, length = graph.neighbours[inside], graph.length[inside]
    ring = _rings(pairs, labels, len(labels))
    band = np.flatnonzero(ring >= 0)
    if not len(band):
        # Another border moved in between, and the two do not touch any more.
        return
    rims = [_rim(band, ring, labels[band] == label) for label in (first, second)]
    within = (ring[pairs] >= 0).all(axis=1)
    place = np.full(len(labels), -1)
    place[band] = np.arange(len(band))
    drift = 1 + DRIFT * (ring[pairs[within]].mean(axis=1) / N_RINGS) ** 2
    side = _first_side(place[pairs[within]], length[within] * drift, rims)
    labels[band] = np.where(side, first, second)


def _rings(pairs: Ints, labels: NDArray[np.int32], n_faces: int) -> Ints:
    """Return for each face how many faces lie between it and the border, -1 if it is far away."""
    ring = np.full(n_faces, -1)
    front = np.unique(pairs[labels[pairs[:, 0]] != labels[pairs[:, 1]]])
    for number in range(N_RINGS + 1):
        ring[front] = number
        near = (ring[pairs] == number).any(axis=1)
        front = np.unique(pairs[near])
        front = front[ring[front] < 0]
    return ring


def _rim(band: Ints, ring: Ints, is_label: Bools) -> Ints:
    """Return the places in the band of the faces of a label that are farthest from the border: they stay."""
    rings = np.where(is_label, ring[band], -1)
    return np.flatnonzero(rings == rings.max())


def _first_side(pairs: Ints, weight: Floats, rims: list[Ints]) -> Bools:
    """Mask (n,) of the places on the first rim's side of the least cut between two rims."""
    n = 1 + max(int(pairs.max()), *(int(rim.max()) for rim in rims))
    capacity = np.maximum(1, np.round(MEAN_CAPACITY * weight / weight.mean())).astype(np.int32)
    endless = np.full(sum(map(len, rims)), np.int32(capacity.sum() + 1))
    source = np.concatenate([pairs[:, 0], pairs[:, 1], np.full(len(rims[0]), n), rims[1]])
    target = np.concatenate([pairs[:, 1], pairs[:, 0], rims[0], np.full(len(rims[1]), n + 1)])
    weights = np.concatenate([capacity, capacity, endless])
    network = csr_array(coo_array((weights, (source, target)), shape=(n + 2, n + 2)))
    rest = network - maximum_flow(network, n, n + 1).flow
    rest.data[rest.data < 0] = 0
    rest.eliminate_zeros()
    reached = np.zeros(n + 2, dtype=bool)
    reached[breadth_first_order(rest, n, return_predecessors=False)] = True
    return reached[:n]
