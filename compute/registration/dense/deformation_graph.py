"""Deformation graphs: the points of a surface follow the rigid motions of a few nodes spread over it.

Sumner, Schmid and Pauly, "Embedded Deformation for Shape Manipulation", SIGGRAPH 2007.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ...surface.mesh import Floats, Ints
from ..eigenfunctions.edge_paths import edge_paths
from ..eigenfunctions.spectral_shape import SpectralShape, farthest_points

# Nodes that a point follows, and nodes that are searched from at once.
FOLLOWED = 4
CHUNK = 128
# Nodes farther along the surface than this many times their mean distance are not followed.
REACH = 4.0


@dataclass(frozen=True, eq=False)
class DeformationGraph:
    """Nodes on a surface of n points, and those of them that every point follows.

    Attributes
    ----------
    points : (n, 3) float64
    nodes : (m, 3) float64
        Places of the nodes.
    followed : (n, 4) int64
        Nodes that each point follows.
    weights : (n, 4) float64
        Sum to 1 for each point.
    edges : (E, 2) int64
        Pairs of nodes that share points, in both directions.
    """

    points: Floats
    nodes: Floats
    followed: Ints
    weights: Floats
    edges: Ints


@dataclass(frozen=True, eq=False)
class Motion:
    """A rigid motion for each node: a place x near node g goes to R (x - g) + g + t.

    Attributes
    ----------
    rotations : (m, 3, 3) float64
    shifts : (m, 3) float64
    """

    rotations: Floats
    shifts: Floats


def deformation_graph(shape: SpectralShape, n_nodes: int) -> DeformationGraph:
    """Return nodes spread over a shape; distances are taken along its edges."""
    chosen = farthest_points(shape.positions, n_nodes)
    nodes = shape.positions[chosen]
    spacing = np.sqrt(shape.areas.sum() / len(chosen))
    followed, distance = _nearest_nodes(shape, chosen, REACH * spacing)
    reach = np.maximum(1.05 * distance.max(axis=1, where=np.isfinite(distance), initial=0), spacing)
    weights = np.where(np.isfinite(distance), np.maximum(1 - distance / reach[:, None], 0) ** 2, 0)
    # A point that no path leads to follows the node that is nearest in space.
    lone = np.flatnonzero(weights.sum(axis=1) == 0)
    if len(lone):
        followed[lone] = cKDTree(nodes).query(shape.positions[lone])[1][:, None]
        weights[lone, 0] = 1.0
    weights /= weights.sum(axis=1, keepdims=True)
    return DeformationGraph(
        points=shape.positions,
        nodes=nodes,
        followed=followed,
        weights=weights,
        edges=_node_pairs(followed, weights, len(nodes)),
    )


def _nearest_nodes(shape: SpectralShape, chosen: Ints, reach: float) -> tuple[Ints, Floats]:
    """Return (n, 4) the nodes nearest to each point along edges, in order, and their distances, infinite beyond."""
    n_points = len(shape.positions)
    followed, distance = np.zeros((n_points, FOLLOWED), dtype=np.int64), np.full((n_points, FOLLOWED), np.inf)
    paths = edge_paths(shape)
    for start in range(0, len(chosen), CHUNK):
        lengths = dijkstra(paths, directed=False, indices=chosen[start : start + CHUNK], limit=reach).T
        node = np.broadcast_to(start + np.arange(lengths.shape[1]), lengths.shape)
        distance, node = np.hstack([distance, lengths]), np.hstack([followed, node])
        best = np.argpartition(distance, FOLLOWED - 1, axis=1)[:, :FOLLOWED]
        distance, followed = np.take_along_axis(distance, best, 1), np.take_along_axis(node, best, 1)
    order = distance.argsort(axis=1, kind="stable")
    return np.take_along_axis(followed, order, 1), np.take_along_axis(distance, order, 1)


def _node_pairs(followed: Ints, weights: Floats, n_nodes: int) -> Ints:
    """Return (E, 2) the pairs of nodes that share points: the nearest of a point with each other that it follows."""
    first = np.repeat(followed[:, 0], FOLLOWED - 1)
    other = followed[:, 1:].ravel()
    counts = (weights[:, 1:].ravel() > 0) & (first != other)
    pairs = np.stack([first[counts], other[counts]], axis=1)
    both = np.unique(np.concatenate([pairs, pairs[:, ::-1]]) @ np.array([n_nodes, 1]))
    return np.stack(np.divmod(both, n_nodes), axis=1)


def warped(graph: DeformationGraph, motion: Motion, chosen: Ints | slice = slice(None)) -> Floats:
    """Return (n, 3) the places of points of the graph after a motion."""
    points, followed, weights = graph.points[chosen], graph.followed[chosen], graph.weights[chosen]
    moved = np.zeros_like(points)
    for place in range(FOLLOWED):
        node = followed[:, place]
        turned = np.einsum("nij,nj->ni", motion.rotations[node], points - graph.nodes[node])
        moved += weights[:, place, None] * (turned + graph.nodes[node] + motion.shifts[node])
    return moved


def turned(graph: DeformationGraph, motion: Motion, directions: Floats, chosen: Ints) -> Floats:
    """Return unit directions (n, 3) at points of the graph as they are turned."""
    rotations = motion.rotations[graph.followed[chosen]]
    moved = np.einsum("nk,nkij,nj->ni", graph.weights[chosen], rotations, directions, optimize=True)
    return moved / np.maximum(np.linalg.norm(moved, axis=1, keepdims=True), np.finfo(float).tiny)


def motion_towards(graph: DeformationGraph, places: Floats) -> Motion:
    """Return the motion that brings the nodes to places (m, 3), each turned as its neighbours are."""
    start, stop = graph.edges.T
    before, after = graph.nodes[stop] - graph.nodes[start], places[stop] - places[start]
    products = (before[:, :, None] * after[:, None, :]).reshape(-1, 9)
    spread = coo_array((products.ravel(), _columns_of(start)), shape=(len(places), 9)).toarray()
    return Motion(nearest_rotations(spread.reshape(-1, 3, 3)), places - graph.nodes)


def _columns_of(rows: Ints) -> tuple[Ints, Ints]:
    return np.repeat(rows, 9), np.tile(np.arange(9), len(rows))


def nearest_rotations(spread: Floats) -> Floats:
    """Return the rotations that turn directions best, from (m, 3, 3) sums of the products before x after."""
    left, _, right = np.linalg.svd(spread)
    flips = np.linalg.det(left @ right) < 0
    left[flips, :, 2] *= -1
    return (left @ right).swapaxes(1, 2)
