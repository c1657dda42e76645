"""Inner walls: triangles that lie inside a shape, such as those of mouth bags, eye sockets and hidden shells.

A triangle is hidden if it is seen from hardly any direction; what hides it may be wound in any way and have holes.
Skin that a pose presses together is hidden, too, but is no inner wall. So hidden triangles have to form a whole shell
or a pocket, which is hollow or has an opening that is shorter than the border of any flat piece of that area.
"""

import numpy as np

from .mesh import Bools, Floats, Ints, TriangleMesh, area_vectors, connected_pieces, sum_by, unit_rows
from .orientation import outward_triangles

# Axes along which a mesh is looked at, from both ends; points on it that hide others, and those in a cell of a picture.
N_AXES = 24
N_BLOCKERS = 80_000
BLOCKERS_OF_CELL = 5.0
# Triangles that are seen under a smaller cosine are left out: their depth changes too much within a cell.
LEAST_COSINE = 0.5
# How far behind the front, in cells, a triangle is still at the front.
DEPTH_OF_FRONT = 0.5
# A triangle that is seen from less than this share of the directions before it is hidden.
HIDDEN = 0.1
# A hemisphere encloses 0.13 times the area to the power of 1.5, a sphere 0.09; pressed skin bulges or encloses 0.03.
LEAST_HOLLOW = 0.06
# Narrow slits enclose little. The border of a flat disc is 3.5 roots of its area long, that of a deep slit less.
LONGEST_OPENING = 2.5
# What is closed but for this many roots of its area is a shell.
LONGEST_GAP = 0.5


def inner_walls(mesh: TriangleMesh) -> Bools:
    """Return (T,) the mask of the triangles that lie inside: pockets with a narrow opening and hidden shells.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh; its winding does not matter.
    """
    hidden = _smoothed(mesh, openness(mesh)) < HIDDEN
    piece = _pieces(mesh, hidden)
    return hidden & _is_inner(mesh, hidden, piece)[piece]


def inner_vertices(triangles: Ints, is_inner: Bools, n_vertices: int) -> Bools:
    """Return (V,) the mask of the vertices that have inner triangles (T,) around them and no others."""
    around, outer = (np.bincount(rows.ravel(), minlength=n_vertices) for rows in (triangles, triangles[~is_inner]))
    return (around > 0) & (outer == 0)


def openness(mesh: TriangleMesh) -> Floats:
    """Return (T,) from how many of the directions before a triangle it is seen, 0 to 1, weighted by the cosine.

    Both sides count, so that no winding is needed; the back of a closed surface is hidden by its front.
    """
    corners = mesh.vertices[mesh.triangles] - mesh.vertices[mesh.triangles].mean(axis=(0, 1))
    centres, normals = corners.mean(axis=1), unit_rows(area_vectors(corners))
    cell = np.sqrt(BLOCKERS_OF_CELL * mesh.areas.sum() / N_BLOCKERS)
    points = np.concatenate([centres, _blockers(corners, mesh.areas)])
    seen, possible = np.zeros(len(centres)), np.zeros(len(centres))
    for frame in _frames(N_AXES):
        cosine = np.abs(normals @ frame[2])
        counts = np.where(cosine > LEAST_COSINE, cosine, 0.0)
        slope = np.sqrt(1 - np.minimum(cosine, 1) ** 2) / np.maximum(cosine, LEAST_COSINE)
        seen += counts * _sides_seen(points @ frame.T, cell, cell * (DEPTH_OF_FRONT + np.sqrt(2) * slope))
        possible += counts
    return np.minimum(seen / np.maximum(possible, np.finfo(float).tiny), 1.0)


def _sides_seen(places: Floats, cell: float, tolerance: Floats) -> Ints:
    """Return from how many of both ends of the third axis each of the first points is seen.

    Parameters
    ----------
    places : (n, 3) float64
        Points that hide one another, the first of which are asked for.
    cell : float
        Side of a cell of the picture.
    tolerance : (q,) float64
        How far behind the front each of the first points may be.
    """
    column = np.floor((places[:, :2] - places[:, :2].min(axis=0)) / cell).astype(np.int64)
    key = column[:, 0] * (column[:, 1].max() + 1) + column[:, 1]
    depth = places[:, 2]
    order = np.argsort(depth)
    front = np.empty(key.max() + 1)
    count = np.zeros(len(tolerance), dtype=np.int64)
    asked = slice(len(tolerance))
    # Of several values for one cell numpy keeps the last.
    for rising in (order, order[::-1]):
        front[key[rising]] = depth[rising]
        count += np.abs(front[key[asked]] - depth[asked]) <= tolerance
    return count


def _blockers(corners: Floats, areas: Floats) -> Floats:
    """Return points on triangles, spread by area, the same ones each time."""
    random = np.random.default_rng(0)
    wanted = N_BLOCKERS * areas / areas.sum()
    n = np.floor(wanted + random.random(len(areas))).astype(np.int64)
    first, second = np.sqrt(random.random(n.sum())), random.random(n.sum())
    weights = np.stack([1 - first, first * (1 - second), first * second], axis=1)
    return np.einsum("nk,nkj->nj", weights, np.repeat(corners, n, axis=0))


def _frames(n_axes: int) -> Floats:
    """Return (n, 3, 3) rotations whose third rows are spread evenly over a hemisphere."""
    height = (np.arange(n_axes) + 0.5) / n_axes
    angle = np.arange(n_axes) * np.pi * (3 - np.sqrt(5))
    radius = np.sqrt(1 - height**2)
    axis = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    across = np.stack([-np.sin(angle), np.cos(angle), np.zeros(n_axes)], axis=1)
    return np.stack([across, np.cross(axis, across), axis], axis=1)


def _smoothed(mesh: TriangleMesh, values: Floats) -> Floats:
    """Return values of triangles, each the mean over the triangles around its corners, by area."""
    n_vertices, areas = len(mesh.vertices), mesh.areas
    corner = mesh.triangles.ravel()
    total = sum_by(corner, np.repeat(areas, 3), n_vertices)
    around = sum_by(corner, np.repeat(areas * values, 3), n_vertices) / np.maximum(total, np.finfo(float).tiny)
    return around[mesh.triangles].mean(axis=1)


def _pieces(mesh: TriangleMesh, hidden: Bools) -> Ints:
    """Return (T,) the piece of hidden triangles joined by edges that each hidden one belongs to."""
    pairs = mesh.edges.neighbours
    pairs = pairs[hidden[pairs].all(axis=1)]
    return connected_pieces(pairs[:, 0], pairs[:, 1], len(mesh.triangles)).astype(np.int64)


def _is_inner(mesh: TriangleMesh, hidden: Bools, piece: Ints) -> Bools:
    """Return for each piece whether it is a hidden shell or a pocket."""
    opening, middle = _openings(mesh, hidden, piece)
    n_pieces = len(opening)
    a, b, c = (mesh.vertices[outward_triangles(mesh)] - middle[piece][:, None]).swapaxes(0, 1)
    # Cones from the middle of the opening over the triangles; the opening itself adds nothing.
    hollow = -sum_by(piece, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6, n_pieces)
    side = np.sqrt(sum_by(piece, mesh.areas, n_pieces))
    is_slit = (hollow > 0) & (opening < LONGEST_OPENING * side)
    return is_slit | (hollow > LEAST_HOLLOW * side**3) | (opening <= LONGEST_GAP * side)


def _openings(mesh: TriangleMesh, hidden: Bools, piece: Ints) -> tuple[Floats, Floats]:
    """Return the length (P,) of the edges between each piece and what is not hidden, and their middle (P, 3)."""
    pairs, n_pieces = mesh.edges.neighbours, int(piece.max()) + 1
    is_rim = hidden[pairs[:, 0]] != hidden[pairs[:, 1]]
    pairs, ends = pairs[is_rim], mesh.vertices[mesh.edges.vertices[mesh.edges.shared[is_rim]]]
    of_edge = piece[np.where(hidden[pairs[:, 0]], pairs[:, 0], pairs[:, 1])]
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    opening = sum_by(of_edge, lengths, n_pieces)
    moments = np.stack([sum_by(of_edge, lengths * column, n_pieces) for column in ends.mean(axis=1).T], axis=1)
    return opening, moments / np.maximum(opening, np.finfo(float).tiny)[:, None]
