"""Nonrigid alignment: a shape is laid onto another as rigidly as possible, from a rough map to surfaces that touch.

Each round takes, for points of the shape as it lies, the nearest point of the other that looks the same way, and moves
the nodes so that points come closer along the normals, while neighbouring nodes stay together. Along the surface points
are free, so features slide into place. Where neighbours disagree much, they may: joints bend there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from ...progress import Progress, silent
from ...surface.mesh import Bools, Floats, Ints, unit_rows
from ..eigenfunctions.spectral_shape import SpectralShape
from .deformation_graph import FOLLOWED, DeformationGraph, Motion, turned, warped
from .surface_points import SurfacePoints, SurfaceTree

# How far a step goes beyond the solution of its linear system: limbs slide around their axes slowly without.
RELAXATION = 1.7
# Distance on a surface of area 1 from which on a point counts little, since it has no partner.
LOST = 0.05
# Candidates for the nearest point, and how much turning of the normal counts as distance.
CANDIDATES = 8
TURN = 0.05
# Distance that the wrong side of a thin part counts as, on a surface of area 1.
WRONG_SIDE = 0.03
# How much a distance along the surface counts, compared with one along the normal.
SLIDING = 0.05
# How much the distance of a point from the place that was given for it counts, as a share of all samples.
PINNED = 0.05
# Keeps nodes that nothing holds.
DAMPING = 1e-6


@dataclass(frozen=True)
class Round:
    """The weights of one round of the alignment.

    Attributes
    ----------
    stiffness : float
        How much it costs when neighbouring nodes disagree, compared with points that are off the surface.
    bend : float
        From this disagreement on, as a fraction of the distance of the nodes, it counts as a joint and costs less.
    """

    stiffness: float
    bend: float


# No joints first, since they would appear wherever the rough map is wrong; then stiff, so that limbs do not twist; soft
# in the end, so that the surfaces touch. Chosen on pairs of seven families of posed characters.
ROUNDS = (
    *(Round(0.3, np.inf),) * 5,
    *(Round(1.0, 0.1),) * 12,
    *(Round(0.2, 0.1),) * 5,
    *(Round(0.05, 0.1),) * 4,
)


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """Places on a surface that points of a graph are drawn to.

    Attributes
    ----------
    chosen : (s,) int64
        Points of the graph.
    places, normals : (s, 3) float64
        Of the surface.
    weights : (s,) float64
    """

    chosen: Ints
    places: Floats
    normals: Floats
    weights: Floats


@dataclass(frozen=True, eq=False)
class Pins:
    """Points of a graph (p,) whose places (p, 3) are given."""

    points: Ints
    places: Floats


NO_PINS = Pins(np.empty(0, dtype=np.int64), np.empty((0, 3)))


@dataclass(frozen=True, eq=False)
class Samples:
    """Points of a graph that are laid onto a surface.

    Attributes
    ----------
    points : (s,) int64
    normals : (s, 3) float64
        At these points, before any motion.
    is_inner : (s,) bool
        Whether they are on inner walls, which are laid onto inner walls.
    """

    points: Ints
    normals: Floats
    is_inner: Bools

    def first(self, n_samples: int) -> Samples:
        """Return the first of them."""
        return Samples(self.points[:n_samples], self.normals[:n_samples], self.is_inner[:n_samples])


def aligned(
    graph: DeformationGraph,
    motion: Motion,
    samples: Samples,
    target: SpectralShape,
    is_inner: Bools,
    pins: Pins = NO_PINS,
    progress: Progress = silent,
) -> Motion:
    """Return the motion that lays a graph onto a surface.

    Parameters
    ----------
    graph : DeformationGraph
    motion : Motion
        To begin with.
    samples : Samples
    target : SpectralShape
        The surface, of T triangles.
    is_inner : (T,) bool
        Its inner walls.
    pins : Pins, optional
    progress : Progress, optional
        Told before each round; may raise `Cancelled`.
    """
    tree = SurfaceTree(target.positions, target.triangles, TURN, WRONG_SIDE, is_inner)
    for number, weights in enumerate(ROUNDS):
        progress(number / len(ROUNDS), "Laying one shape onto the other")
        places, normals = warped(graph, motion, samples.points), turned(graph, motion, samples.normals, samples.points)
        points, distance = tree.nearest(places, normals, CANDIDATES, samples.is_inner)
        has_partner = is_inner[points.triangles] == samples.is_inner
        closest = _closest_points(samples.points, normals, points, np.where(has_partner, distance, np.inf), target)
        motion = gauss_newton_step(graph, motion, closest, weights, pins)
    return motion


def _closest_points(
    samples: Ints, sample_normals: Floats, points: SurfacePoints, distance: Floats, target: SpectralShape
) -> ClosestPoints:
    """Return nearest points with weights that fall with the distance and with the turn of the normal."""
    normals = unit_rows(points.blend(target.normals, target.triangles))
    away = distance**2 + TURN**2 * ((sample_normals - normals) ** 2).sum(axis=1)
    weights = 1 / (len(samples) * (1 + away / LOST**2) ** 2)
    return ClosestPoints(samples, points.blend(target.positions, target.triangles), normals, weights)


def gauss_newton_step(
    graph: DeformationGraph, motion: Motion, closest: ClosestPoints, weights: Round, pins: Pins = NO_PINS
) -> Motion:
    """Return the motion after one Gauss-Newton step towards closest points and pins, as rigidly as the weights want."""
    rows = [_distances(graph, motion, closest), _disagreements(graph, motion, weights), _pulls(graph, motion, pins)]
    jacobian = _stacked([matrix for matrix, _ in rows])
    residual = np.concatenate([values for _, values in rows])
    n = jacobian.shape[1]
    normal_matrix = (jacobian.T @ jacobian + diags_array(np.full(n, DAMPING))).tocsc()
    options = {"SymmetricMode": True}
    factor = splu(normal_matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options=options)
    step = -RELAXATION * factor.solve(jacobian.T @ residual).reshape(-1, 6)
    return Motion(_rotations(step[:, :3]) @ motion.rotations, motion.shifts + step[:, 3:])


def _stacked(matrices: list[csr_array]) -> csr_array:
    indptr, offset = [np.zeros(1, dtype=np.int64)], 0
    for matrix in matrices:
        indptr.append(matrix.indptr[1:] + offset)
        offset += matrix.nnz
    data, indices = (np.concatenate([getattr(matrix, name) for matrix in matrices]) for name in ("data", "indices"))
    n_rows = sum(matrix.shape[0] for matrix in matrices)
    return csr_array((data, indices, np.concatenate(indptr)), shape=(n_rows, matrices[0].shape[1]))


def _distances(graph: DeformationGraph, motion: Motion, closest: ClosestPoints) -> tuple[csr_array, Floats]:
    """Return derivatives and values of the distances: along the normal, and a little along each axis."""
    away = warped(graph, motion, closest.chosen) - closest.places
    axes = [closest.normals] + [np.broadcast_to(SLIDING * axis, away.shape) for axis in np.eye(3)]
    directions = np.concatenate(axes) * np.tile(np.sqrt(closest.weights), 4)[:, None]
    return _along(graph, motion, np.tile(closest.chosen, 4), directions, np.tile(away, (4, 1)))


def _pulls(graph: DeformationGraph, motion: Motion, pins: Pins) -> tuple[csr_array, Floats]:
    """Return derivatives and values of the distances of pinned points from their places, along each axis."""
    away = warped(graph, motion, pins.points) - pins.places
    directions = np.repeat(np.sqrt(PINNED) * np.eye(3), len(away), axis=0)
    return _along(graph, motion, np.tile(pins.points, 3), directions, np.tile(away, (3, 1)))


def _along(
    graph: DeformationGraph, motion: Motion, chosen: Ints, directions: Floats, away: Floats
) -> tuple[csr_array, Floats]:
    """Return derivatives and values of how far chosen points are away along directions."""
    followed, weights = graph.followed[chosen], graph.weights[chosen]
    blocks = np.empty((len(chosen), FOLLOWED, 6))
    for place in range(FOLLOWED):
        arms = graph.points[chosen] - graph.nodes[followed[:, place]]
        arms = np.einsum("nij,nj->ni", motion.rotations[followed[:, place]], arms)
        blocks[:, place, :3] = weights[:, place, None] * np.cross(arms, directions)
        blocks[:, place, 3:] = weights[:, place, None] * directions
    return _block_rows(blocks, followed, len(graph.nodes)), np.einsum("nj,nj->n", away, directions)


def _disagreements(graph: DeformationGraph, motion: Motion, weights: Round) -> tuple[csr_array, Floats]:
    """Return derivatives and values of the gaps between the places to which two neighbouring nodes move one of them."""
    start, stop = graph.edges.T
    between = graph.nodes[stop] - graph.nodes[start]
    arms = np.einsum("nij,nj->ni", motion.rotations[start], between)
    gaps = arms + motion.shifts[start] - between - motion.shifts[stop]
    share = np.linalg.norm(gaps, axis=1) / np.maximum(np.linalg.norm(between, axis=1), np.finfo(float).tiny)
    factor = np.sqrt(weights.stiffness / max(len(start), 1) * np.maximum(1 / (1 + (share / weights.bend) ** 2), 1e-2))
    blocks = np.zeros((3, len(start), 2, 6))
    for axis, direction in enumerate(np.eye(3)):
        blocks[axis, :, 0, :3] = np.cross(arms, direction)
        blocks[axis, :, 0, 3 + axis] = 1.0
        blocks[axis, :, 1, 3 + axis] = -1.0
    blocks *= factor[None, :, None, None]
    nodes = np.tile(graph.edges, (3, 1))
    return _block_rows(blocks.reshape(-1, 2, 6), nodes, len(graph.nodes)), (gaps * factor[:, None]).T.ravel()


def _block_rows(blocks: Floats, nodes: Ints, n_nodes: int) -> csr_array:
    """Return a matrix whose row r has (6,) numbers in the columns of each of its nodes."""
    n_rows, width, _ = blocks.shape
    columns = (6 * nodes[:, :, None] + np.arange(6)).ravel()
    rows = np.repeat(np.arange(n_rows), 6 * width)
    return coo_array((blocks.ravel(), (rows, columns)), shape=(n_rows, 6 * n_nodes)).tocsr()


def _rotations(vectors: Floats) -> Floats:
    """Return rotations about axes (m, 3) by angles that are their lengths."""
    angle = np.linalg.norm(vectors, axis=1)
    x, y, z = (vectors / np.maximum(angle, np.finfo(float).tiny)[:, None]).T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    sine, versine = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    return np.eye(3) + sine * cross + versine * (cross @ cross)
