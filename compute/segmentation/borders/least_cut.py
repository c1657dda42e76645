"""The least cut of a graph between what is inside and what is outside."""

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

from ...surface.mesh import Bools, Floats, Ints

# What it costs to leave an area to the other side of its border: this over the radius of a circle as long as the
# border, so that a border may move by a part of the limb it runs around, whatever its size.
STRAYING = 2.0
# Capacities of a flow are whole numbers; an edge of mean length has this one.
MEAN_CAPACITY = 10000


def least_cut(pairs: Ints, length: Floats, inside: Bools, outside: Bools, gain: Floats | None = None) -> Bools:
    """Mask (n,) of the nodes inside the shortest border around some that lie inside for sure.

    Parameters
    ----------
    pairs : (P, 2) int64
        Nodes that are neighbours.
    length : (P,) float64
        What it costs to lie on different sides.
    inside, outside : (n,) bool
        Nodes whose side is known.
    gain : (n,) float64, optional
        What each node saves if it lies inside, in the unit of the length; less than 0 if it costs.
    """
    n = len(inside)
    scale = MEAN_CAPACITY / length.mean()
    capacity = np.maximum(1, np.round(scale * length)).astype(np.int32)
    endless = int(capacity.sum()) + 1
    saved = np.zeros(n) if gain is None else np.round(scale * gain)
    entering = np.where(inside, endless, np.clip(saved, 0, endless)).astype(np.int32)
    leaving = np.where(outside, endless, np.clip(-saved, 0, endless)).astype(np.int32)
    entered, left = np.flatnonzero(entering), np.flatnonzero(leaving)
    source = np.concatenate([pairs[:, 0], pairs[:, 1], np.full(len(entered), n), left])
    target = np.concatenate([pairs[:, 1], pairs[:, 0], entered, np.full(len(left), n + 1)])
    capacities = np.concatenate([capacity, capacity, entering[entered], leaving[left]])
    network = csr_array(coo_array((capacities, (source, target)), shape=(n + 2, n + 2)))
    rest = network - maximum_flow(network, n, n + 1).flow
    rest.data[rest.data < 0] = 0
    rest.eliminate_zeros()
    reached = np.zeros(n + 2, dtype=bool)
    reached[breadth_first_order(rest, n, return_predecessors=False)] = True
    return reached[:n]
