"""Winding: neighbouring triangles turn the same way, and closed shells turn outward."""

from dataclasses import dataclass

import numpy as np

from .mesh import Bools, Floats, Ints, TriangleMesh, connected_pieces

# A patch whose openings are longer than this, in units of the root of its area, has no inside.
LONGEST_OPENING = 1.0


def wrongly_wound(mesh: TriangleMesh) -> Bools:
    """Return (T,) the mask of the triangles to reverse, so that all are wound consistently and outward.

    Patches are triangles connected through edges of exactly two. A patch that is closed, or has small
    openings only, is turned so that its volume is positive; an open one so that the greater part of its area stays
    as it was. One-sided patches (a Möbius strip) stay as they are.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    """
    turned, patch = _turn_within_patches(mesh)
    return turned ^ _patches_to_turn(mesh, turned, patch)[patch]


def outward_triangles(mesh: TriangleMesh) -> Ints:
    """Return (T, 3) the triangles, those that are wrongly wound reversed."""
    return reversed_where(mesh.triangles, wrongly_wound(mesh))


def reversed_where(triangles: Ints, turned: Bools) -> Ints:
    """Return (T, 3) triangles, the marked ones with the opposite winding."""
    return np.where(turned[:, None], triangles[:, ::-1], triangles)


def _turn_within_patches(mesh: TriangleMesh) -> tuple[Bools, Ints]:
    """Return (T,) the triangles to turn so that neighbours agree, and the patch of each triangle.

    Triangle t stands twice in a graph, as it is (t) and turned (t + T); neighbours that agree join like with like.
    A patch with two sides falls into two mirror images, of which the one with its first triangle unturned is taken.
    """
    n_triangles = len(mesh.triangles)
    joints = _joints(mesh)
    left, right = joints.triangles.T
    if joints.agree.all():
        return np.zeros(n_triangles, dtype=bool), connected_pieces(left, right, n_triangles)
    ends = np.where(joints.agree, right, right + n_triangles)
    opposite = np.where(joints.agree, right + n_triangles, right)
    rows, columns = np.concatenate([left, left + n_triangles]), np.concatenate([ends, opposite])
    sides = connected_pieces(rows, columns, 2 * n_triangles).reshape(2, n_triangles)
    patch_name = sides.min(axis=0)
    _, first, patch = np.unique(patch_name, return_index=True, return_inverse=True)
    patch = patch.reshape(-1)
    return sides[0] != sides[0][first][patch], patch


@dataclass(frozen=True, eq=False)
class _Joints:
    """Pairs of triangles at edges that only they share, and whether they pass the edge in opposite directions."""

    triangles: Ints
    agree: Bools


def _joints(mesh: TriangleMesh) -> _Joints:
    edges = mesh.edges
    is_manifold = edges.n_triangles[edges.shared] == 2
    pairs, shared = edges.neighbours[is_manifold], edges.shared[is_manifold]
    is_forward = mesh.triangles < np.roll(mesh.triangles, -1, axis=1)
    # The shared one of the three edges of each triangle of a pair.
    place = (edges.of_triangle[pairs] == shared[:, None, None]).argmax(axis=2)
    forward = is_forward[pairs, place]
    return _Joints(pairs, forward[:, 0] != forward[:, 1])


def _patches_to_turn(mesh: TriangleMesh, turned: Bools, patch: Ints) -> Bools:
    """Return the mask of the patches that have to be turned as a whole."""
    n_patches = int(patch.max()) + 1
    area = np.bincount(patch, mesh.areas, n_patches)
    turned_area = np.bincount(patch, mesh.areas * turned, n_patches)
    volume, opening = _volumes(mesh, reversed_where(mesh.triangles, turned), patch, n_patches)
    has_inside = opening <= LONGEST_OPENING * np.sqrt(area)
    return np.where(has_inside, volume < 0, turned_area > 0.5 * area)


def _volumes(mesh: TriangleMesh, triangles: Ints, patch: Ints, n_patches: int) -> tuple[Floats, Floats]:
    """Return the signed volume of each patch, seen from the middle of its openings, and the length of these."""
    edges = mesh.edges
    is_open = (edges.n_triangles != 2)[edges.of_triangle]
    starts, stops = mesh.vertices[triangles], mesh.vertices[np.roll(triangles, -1, axis=1)]
    length = np.linalg.norm(mesh.vertices[edges.vertices[:, 1]] - mesh.vertices[edges.vertices[:, 0]], axis=1)
    opening = np.bincount(patch, (length[edges.of_triangle] * is_open).sum(axis=1), n_patches)
    # A cone over one opening adds nothing to the volume if its tip is the origin.
    weight = np.where(opening[patch][:, None] > 0, length[edges.of_triangle] * is_open, length[edges.of_triangle])
    middle = _means((starts + stops) / 2, weight, patch, n_patches)
    a, b, c = (starts - middle[patch][:, None]).swapaxes(0, 1)
    volume = np.bincount(patch, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6, n_patches)
    return volume.astype(float), opening.astype(float)


def _means(points: Floats, weights: Floats, patch: Ints, n_patches: int) -> Floats:
    total = np.bincount(patch, weights.sum(axis=1), n_patches)
    sums = np.einsum("tkj,tk->tj", points, weights)
    moments = np.stack([np.bincount(patch, column, n_patches) for column in sums.T], axis=1)
    return moments / np.maximum(total, np.finfo(float).tiny)[:, None]
