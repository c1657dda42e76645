"""Borders along existing edges: the shortest lines of edges near the borders of given labels."""

import numpy as np
from numpy.typing import NDArray

from ...surface.mesh import Bools, Ints
from ..faces.face_graph import FaceGraph
from .least_cut import STRAYING, least_cut

# How many rings of faces a border may move.
N_RINGS = 4
# On which side the faces at a jagged border itself lie says little: this share of what it says of others.
JAGGED = 0.1


def shortened_borders(labels: NDArray[np.int32], graph: FaceGraph) -> NDArray[np.int32]:
    """Return labels (F,) whose borders are short within a few rings of faces, and near where they were.

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
    inside, outside = (_rim(band, ring, labels[band] == label) for label in (first, second))
    within = (ring[pairs] >= 0).all(axis=1)
    place = np.full(len(labels), -1)
    place[band] = np.arange(len(band))
    radius = length[labels[pairs[:, 0]] != labels[pairs[:, 1]]].sum() / (2 * np.pi)
    strays = graph.area[band] * np.where(ring[band] > 0, 1, JAGGED)
    gain = STRAYING / radius * strays * np.where(labels[band] == first, 1, -1)
    side = least_cut(place[pairs[within]], length[within], inside, outside, gain)
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


def _rim(band: Ints, ring: Ints, is_label: Bools) -> Bools:
    """Mask of the faces of a label in the band that are farthest from the border: they stay."""
    rings = np.where(is_label, ring[band], -1)
    return np.asarray(rings == rings.max())
