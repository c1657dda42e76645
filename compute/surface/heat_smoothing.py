"""Smoothing along the surface by a short flow of heat, and harmonic filling of unknown values."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array, eye_array
from scipy.sparse.linalg import cg, splu

from ..errors import MeshError
from ..memory import told_if_full
from .mesh import Bools, Floats, Ints, TriangleMesh, connected_pieces

# Heat that has spread for a time t from one side of a straight line falls from 90 % to 10 % over 2 ln 5 sqrt(t).
WIDTH_OF_UNIT_TIME = 2 * np.log(5)
# After this time, in areas of the mesh, heat is even on all but the thinnest threads; later nothing changes any more.
LONGEST_TIME = 1e4
# Weights below this are not worth a place in a vertex group.
LEAST_WEIGHT = 1e-3
# Triangles flatter than this fraction of the mean area count as if they had it.
LEAST_AREA = 1e-6
# What a system with ones on its diagonal is made regular by.
LEAST_STIFFNESS = 1e-12


def smoothed(mesh: TriangleMesh, values: Floats, width: float, tolerance: float = 1e-6) -> Floats:
    """Return values on the vertices after heat has spread, so that a step becomes a slope of the given width.

    Constants stay as they are, integrals too; nothing passes between pieces that are not connected.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (V, n) float64
    width : float
        Distance on the surface over which a step falls from 90 % to 10 %, in the mesh's unit.
    tolerance : float
        How far off the solution may be, relative to the values.

    Raises
    ------
    MeshError
        If the width is negative or not a number.

    References
    ----------
    .. [1] Crane, Weischedel, Wardetzky, "Geodesics in Heat", ACM TOG 2013: the first of its three steps.
    """
    if not (np.isfinite(width) and width >= 0):
        raise MeshError(f"The width is a distance, zero or more, not {width}.")
    time = min(width / WIDTH_OF_UNIT_TIME, np.sqrt(LONGEST_TIME * mesh.areas.sum())) ** 2
    mass = _vertex_areas(mesh)
    system = (diags_array(mass) + time * stiffness(mesh)).tocsr()
    precondition = diags_array(1 / system.diagonal())
    columns = [cg(system, mass * column, x0=column, rtol=tolerance, M=precondition)[0] for column in values.T]
    return np.stack(columns, axis=1)


@told_if_full
def softened_labels(mesh: TriangleMesh, labels: NDArray[np.int32], width: float) -> tuple[Ints, Floats]:
    """Return the share of each label at each vertex when the borders are softened.

    Parameters
    ----------
    mesh : TriangleMesh
    labels : (V,) int32
    width : float
        As for :func:`smoothed`.

    Returns
    -------
    kinds : (P,) int64
        The labels that occur.
    weights : (V, P) float64
        From 0 to 1, a sum of 1 for each vertex.
    """
    kinds, column = np.unique(labels, return_inverse=True)
    hard = (column.reshape(-1, 1) == np.arange(len(kinds))).astype(np.float64)
    weights = smoothed(mesh, hard, width)
    weights[weights < LEAST_WEIGHT] = 0.0
    return kinds.astype(np.int64), weights / weights.sum(axis=1, keepdims=True)


def harmonic_fill(mesh: TriangleMesh, values: Floats, is_known: Bools) -> Floats:
    """Return values with the unknown ones filled in as smoothly as the known ones around them allow.

    A filled value is a weighted mean of those around it, so nothing becomes larger or smaller than what is known, and
    constants and sums stay. Pieces of the mesh without any known value keep what they have.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (V, n) float64
    is_known : (V,) bool

    Returns
    -------
    (V, n) float64
    """
    edges = mesh.edges.vertices
    n = len(mesh.vertices)
    # Weights by length instead of angles are never negative, whatever the triangles look like.
    lengths = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)
    weight = 1 / np.maximum(lengths, 1e-3 * max(float(lengths.mean()), 1e-300))
    graph = coo_array((weight, (edges[:, 0], edges[:, 1])), shape=(n, n)).tocsr()
    graph = (graph + graph.T).tocsr()
    unknown = _unknown_beside_known(mesh, is_known)
    filled = values.copy()
    if len(unknown):
        rows = graph[unknown]
        system = diags_array(np.asarray(rows.sum(axis=1)).ravel()) - rows[:, unknown]
        filled[unknown] = splu(system.tocsc()).solve(np.ascontiguousarray(rows[:, is_known] @ values[is_known]))
    return filled


def biharmonic_fill(mesh: TriangleMesh, values: Floats, is_known: Bools) -> Floats:
    """Return values with the unknown ones filled in so that they bend least and go on with the slope at their border.

    Slopes reach far into what is open, such as a skirt between two legs, where those of ``harmonic_fill`` end at the
    border. Each column stays between its least and largest known value; sums over columns may be off by what that
    cuts away. Pieces of the mesh without any known value keep what they have.

    Parameters
    ----------
    mesh : TriangleMesh
    values : (V, n) float64
    is_known : (V,) bool

    Returns
    -------
    (V, n) float64

    References
    ----------
    .. [1] Abdrashitov et al., "Robust Skin Weights Transfer via Weight Inpainting", SIGGRAPH Asia 2023.
    """
    laplacian = stiffness(mesh)
    bending = (laplacian @ diags_array(1 / _vertex_areas(mesh)) @ laplacian).tocsr()
    unknown = _unknown_beside_known(mesh, is_known)
    filled = values.copy()
    if len(unknown):
        known, rows = values[is_known], bending[unknown]
        # Entries are the inverse sizes of triangles to the fourth, so that those of slivers would drown all others.
        diagonal = rows[:, unknown].diagonal()
        scale = diags_array(1 / np.sqrt(np.where(diagonal > 0, diagonal, 1.0)))
        # Vertices that hang on flat triangles alone would be undetermined.
        system = scale @ rows[:, unknown] @ scale + LEAST_STIFFNESS * eye_array(len(unknown))
        solved = scale @ splu(system.tocsc()).solve(np.ascontiguousarray(-(scale @ (rows[:, is_known] @ known))))
        filled[unknown] = np.clip(solved, known.min(axis=0), known.max(axis=0))
    return filled


def piece_of_vertices(mesh: TriangleMesh) -> Ints:
    """Return (V,) the piece of each vertex that hangs together by edges."""
    edges = mesh.edges.vertices
    return connected_pieces(edges[:, 0], edges[:, 1], len(mesh.vertices))


def _unknown_beside_known(mesh: TriangleMesh, is_known: Bools) -> Ints:
    """Return the unknown vertices of pieces that have known ones."""
    piece = piece_of_vertices(mesh)
    return np.flatnonzero(~is_known & np.isin(piece, piece[is_known]))


def stiffness(mesh: TriangleMesh) -> csr_array:
    """Return the (V, V) cotangent matrix of linear elements, positive semidefinite."""
    corners = mesh.vertices[mesh.triangles]
    area = np.maximum(mesh.areas, LEAST_AREA * mesh.areas.mean())
    rows, columns, weights = [], [], []
    for k in range(3):
        # The cotangent at a corner weighs the side opposite to it.
        left, right = corners[:, k - 2] - corners[:, k], corners[:, k - 1] - corners[:, k]
        cotangent = np.einsum("ij,ij->i", left, right) / (4 * area)
        ends = mesh.triangles[:, [k - 2, k - 1]]
        rows += [ends[:, 0], ends[:, 1]]
        columns += [ends[:, 1], ends[:, 0]]
        weights += [-cotangent, -cotangent]
    n = len(mesh.vertices)
    places = (np.concatenate(rows), np.concatenate(columns))
    off_diagonal = coo_array((np.concatenate(weights), places), shape=(n, n)).tocsr()
    return (off_diagonal - diags_array(off_diagonal.sum(axis=1))).tocsr()


def _vertex_areas(mesh: TriangleMesh) -> Floats:
    """Return a third of the area of all triangles around each vertex; a little for vertices without any."""
    areas = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas / 3, 3), len(mesh.vertices))
    return np.maximum(areas, LEAST_AREA * mesh.areas.mean())
