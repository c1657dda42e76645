"""True parts from skinning weights: each vertex goes to the part with the most weight, each part is one piece."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def heaviest_part(weights: Floats, quads: Ints) -> Ints:
    """Return the part of each vertex.

    A patch that is cut off from the rest of its part goes to the part with the next most weight.

    Parameters
    ----------
    weights : (V, P) float64
        Share of each part in each vertex.
    quads : (Q, 4) int
        Faces of a connected mesh.

    Returns
    -------
    (V,) int64
    """
    weights = weights.copy()
    part = weights.argmax(axis=1)
    while (stray := _is_stray(part, quads)).any():
        weights[stray, part[stray]] = -1.0
        part = weights.argmax(axis=1)
    return part


def majority(part: Ints, faces: Ints) -> Ints:
    """Return for each quad the part that three of its corners have, or else one of the two commonest."""
    return np.sort(part[faces], axis=1)[:, 1]


def _is_stray(part: Ints, quads: Ints) -> Bools:
    """Return which vertices are not in the largest piece of their part."""
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    ends = ends[part[ends[:, 0]] == part[ends[:, 1]]]
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(part), len(part)))
    n_pieces, piece = connected_components(graph, directed=False)
    size = np.bincount(piece)
    largest = np.zeros(n_pieces, dtype=bool)
    part_of_piece = np.zeros(n_pieces, dtype=np.int64)
    part_of_piece[piece] = part
    order = np.lexsort([-size, part_of_piece])
    largest[order[np.unique(part_of_piece[order], return_index=True)[1]]] = True
    return ~largest[piece]
