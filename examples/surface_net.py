"""Quad meshes of implicit bodies: surface nets, evened out on the surface.

References
----------
.. [1] Gibson, "Constrained Elastic Surface Nets", MICCAI 1998.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.spatial import cKDTree

from .grid import Grid, magnified_bounds, mixed_cells, sample, well_composed_inside
from .magnifier import Magnifiers
from .solids import FAR, Body

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

# Cells along the longest side of the first grid that is tried; the number of vertices then tells the right one.
FIRST_CELLS = 100
# The mesh may miss the wished number of vertices by this share.
TOLERANCE = 0.02
MAX_TRIES = 5
# Rounds of evening out, and final steps onto the surface.
ROUNDS, FINAL_STEPS = 12, 3

# No vertex of a usable net is farther from the surface than this, in metres.
SLACK = 0.03

CORNERS = np.array(list(product((0, 1), repeat=3)))
CELL_EDGES = np.array([(a, a + step) for step in (1, 2, 4) for a in range(8) if not a & step])


@dataclass(frozen=True, eq=False)
class QuadMesh:
    """A closed quad mesh.

    Attributes
    ----------
    vertices : (V, 3) float64
    quads : (Q, 4) int64
        Counter-clockwise seen from outside; the diagonal from the first to the third corner is the shorter one.
    """

    vertices: Floats
    quads: Ints


def mesh_body(body: Body, n_vertices: int, magnifiers: Magnifiers) -> QuadMesh:
    """Return a mesh of the surface of a body.

    Parameters
    ----------
    body : Body
    n_vertices : int
        How many vertices it is to have, within a few percent.
    magnifiers : Magnifiers
        Where the mesh is finer.

    Returns
    -------
    QuadMesh
        One closed manifold component.

    Raises
    ------
    ValueError
        If the body has parts too thin for that few vertices.
    """
    cell = float(np.ptp(magnified_bounds(body, magnifiers), axis=0).max()) / FIRST_CELLS
    for _ in range(MAX_TRIES):
        grid = sample(body, cell, magnifiers)
        inside = well_composed_inside(grid.values)
        n_found = int(mixed_cells(inside).sum())
        if abs(n_found - n_vertices) <= TOLERANCE * n_vertices:
            break
        cell *= np.sqrt(n_found / n_vertices)
    net = surface_net(grid, inside)
    mesh = evened(QuadMesh(magnifiers.shrunk(net.vertices), net.quads), body)
    return symmetrized(mesh) if body.symmetric else mesh


def surface_net(grid: Grid, inside: Bools) -> QuadMesh:
    """Return the net with a vertex in every cell that the surface crosses and a quad around every crossed grid edge."""
    cells = np.argwhere(mixed_cells(inside))
    number = np.full(inside.shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    vertices = grid.origin + grid.cell * (cells + _mean_crossing(grid.values, inside, cells))
    return QuadMesh(vertices, np.concatenate([_quads_across(axis, inside, number) for axis in range(3)]))


def evened(mesh: QuadMesh, body: Body) -> QuadMesh:
    """Return the mesh with its vertices evened out within the surface and set onto it."""
    average = _neighbour_average(mesh.quads, len(mesh.vertices))
    vertices = mesh.vertices
    for _ in range(ROUNDS):
        vertices, normals = _onto(body, vertices)
        step = average @ vertices - vertices
        step -= np.einsum("ij,ij->i", step, normals)[:, None] * normals
        vertices = vertices + 0.5 * step
    for _ in range(FINAL_STEPS):
        vertices, _ = _onto(body, vertices)
    return QuadMesh(vertices, _with_shorter_diagonal(vertices, mesh.quads))


def symmetrized(mesh: QuadMesh) -> QuadMesh:
    """Return the mesh without the rounding errors by which it is not its own mirror image in x = 0."""
    images = mesh.vertices[mirror_of_vertex(mesh.vertices)] * (-1.0, 1.0, 1.0)
    vertices = 0.5 * (mesh.vertices + images)
    return QuadMesh(vertices, _with_shorter_diagonal(vertices, mesh.quads))


def mirror_of_vertex(vertices: Floats) -> Ints:
    """Return for each vertex the one nearest to its mirror image in x = 0."""
    return cKDTree(vertices).query(vertices * (-1.0, 1.0, 1.0))[1]


def _mean_crossing(values: NDArray[np.float32], inside: Bools, cells: Ints) -> Floats:
    """(V, 3) the mean of the points at which the surface crosses the edges of each cell, in cells from its corner."""
    index = tuple((cells[:, None] + CORNERS).transpose(2, 0, 1))
    depth = np.maximum(np.abs(values[index]).astype(np.float64), 1e-9)
    is_inside = inside[index]
    total, count = np.zeros((len(cells), 3)), np.zeros(len(cells))
    for a, b in CELL_EDGES:
        crossed = is_inside[:, a] != is_inside[:, b]
        share = depth[:, a] / (depth[:, a] + depth[:, b])
        total += crossed[:, None] * (CORNERS[a] + share[:, None] * (CORNERS[b] - CORNERS[a]))
        count += crossed
    return total / count[:, None]


def _quads_across(axis: int, inside: Bools, number: Ints) -> Ints:
    """(Q, 4) the quads around the crossed grid edges along one axis."""
    first = np.moveaxis(inside, axis, 0)
    start = np.argwhere(first[:-1] != first[1:])
    outward = first[:-1][tuple(start.T)]
    around = np.array([[0, -1, -1], [0, 0, -1], [0, 0, 0], [0, -1, 0]])
    cells = start[:, None] + around
    quads = np.moveaxis(number, axis, 0)[tuple(cells.transpose(2, 0, 1))]
    # Moving the axis to the front keeps the hand of the other two for x and z, and swaps it for y.
    return np.where((outward if axis != 1 else ~outward)[:, None], quads, quads[:, ::-1])


def _neighbour_average(quads: Ints, n_vertices: int) -> csr_array:
    """(V, V) the matrix that takes values to the mean over the neighbours along edges."""
    ends = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    adjacency = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n_vertices, n_vertices)).tocsr()
    return (diags_array(1.0 / adjacency.sum(axis=1)) @ adjacency).tocsr()


def _onto(body: Body, vertices: Floats) -> tuple[Floats, Floats]:
    """Return the vertices after a Newton step onto the surface, and its normals."""
    distance, gradient = body.distance(vertices, SLACK)
    # In the crease of a fillet the gradients of the two sides cancel in part; the step must not grow without bound.
    steepness = np.maximum(np.linalg.norm(gradient, axis=1, keepdims=True), 0.5)
    normals = gradient / steepness
    return vertices - (np.where(distance < FAR / 2, distance, 0.0)[:, None] / steepness) * normals, normals


def _with_shorter_diagonal(vertices: Floats, quads: Ints) -> Ints:
    """Return the quads, begun at the corner from which the shorter diagonal leaves."""
    corners = vertices[quads]
    even = np.linalg.norm(corners[:, 2] - corners[:, 0], axis=1)
    odd = np.linalg.norm(corners[:, 3] - corners[:, 1], axis=1)
    return np.where((even <= odd * (1.0 + 1e-9))[:, None], quads, np.roll(quads, -1, axis=1))
