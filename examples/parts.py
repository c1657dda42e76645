"""True parts from skinning weights: each vertex goes to the part with the most weight, and each part is one piece."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def heaviest_part(weights: Floats, quads: Ints) -> Ints:
    """Return the part of each vertex.

    A patch that is cut off from the rest of its part goes to the parts around it.

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
    part = weights.argmax(axis=1)
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    settled = _in_largest_piece(part, ends)
    if settled.all():
        return part
    # A shortest path from the nearest settled vertex keeps its part all along, so parts stay connected.
    _, _, source = dijkstra(
        _graph(ends, len(part)), indices=np.flatnonzero(settled), min_only=True, return_predecessors=True
    )
    return part[source]


def majority(part: Ints, faces: Ints) -> Ints:
    """Return for each quad the part that three of its corners have, or else one of the two commonest."""
    return np.sort(part[faces], axis=1)[:, 1]


def _in_largest_piece(part: Ints, ends: Ints) -> Bools:
    """Return which vertices are in the largest piece of their part."""
    within = part[ends[:, 0]] == part[ends[:, 1]]
    n_pieces, piece = connected_components(_graph(ends[within], len(part)), directed=False)
    size, part_of_piece = np.bincount(piece), np.zeros(n_pieces, dtype=np.int64)
    part_of_piece[piece] = part
    by_part_and_size = np.lexsort([-size, part_of_piece])
    _, first = np.unique(part_of_piece[by_part_and_size], return_index=True)
    return np.isin(piece, by_part_and_size[first])


def _graph(ends: Ints, n_vertices: int) -> csr_array:
    return coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n_vertices, n_vertices)).tocsr()
