"""Transfer along a correspondence: displacements, values at corners of faces, labels."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array

from ...memory import told_if_full
from ...surface.heat_smoothing import biharmonic_fill, harmonic_fill, piece_of_vertices
from ...surface.mesh import Bools, Floats, Ints, TriangleMesh, area_vectors, connected_pieces, unit_rows
from .correspondence import BY_PLACE, Correspondence
from .deformation_graph import nearest_rotations
from .surface_points import SurfacePoints, SurfaceTree

# Seams are kept between at most this many pieces; a layer with more is taken as it is at each corner.
MOST_ISLANDS = 400
# Of a piece that lies on the source with less than this share of its vertices nothing is filled in: of a helmet with
# 0.13 the filled weights were twice as far off as the nearest, with 0.49 less far.
LEAST_SUPPORT = 0.3
# Values at the two sides of an edge that differ by less than this belong together, as a fraction of their range.
SAME_VALUE = 1e-5


@told_if_full
def fill_unsure(correspondence: Correspondence, target: TriangleMesh, values: Floats) -> Floats:
    """Return values (Vt, n) with those of unsure vertices filled in smoothly from the sure ones around them.

    By place, pieces of which less than `LEAST_SUPPORT` is sure keep what they have: the nearest is more likely right.
    """
    if correspondence.found_by != BY_PLACE:
        return harmonic_fill(target, values, correspondence.is_sure)
    # What hangs over, as a skirt between the legs, goes on with the slope of what lies on the source.
    piece = piece_of_vertices(target)
    share = np.bincount(piece, correspondence.is_sure) / np.bincount(piece)
    return biharmonic_fill(target, values, correspondence.is_sure | (share < LEAST_SUPPORT)[piece])


@told_if_full
def transfer_displacements(
    correspondence: Correspondence, source: TriangleMesh, target: TriangleMesh, displacements: Floats
) -> Floats:
    """Return (Vt, 3) displacements (Vs, 3) of the source's vertices, turned and scaled as the surface is there.

    By place they stay as they are: both meshes are in one space.
    """
    if correspondence.found_by == BY_PLACE:
        return correspondence.transfer(displacements)
    turns = local_turns(correspondence, source, target)
    scale = np.sqrt(target.areas.sum() / source.areas.sum())
    return scale * np.einsum("nij,nj->ni", turns, correspondence.transfer(displacements))


def local_turns(correspondence: Correspondence, source: TriangleMesh, target: TriangleMesh) -> Floats:
    """Return (Vt, 3, 3) the turn of the surface around each vertex, from the source to the target.

    Rotations; with a reflection where the mirror image of the source was matched.
    """
    matching = correspondence.matching
    mirror = np.diag([-1.0, 1.0, 1.0]) if matching is not None and matching.mirrored else np.eye(3)
    places = correspondence.transfer(source.vertices) @ mirror
    spread = _edge_products(places, target) + _normal_products(places, target)
    # A vertex that many edges of no length surround has the turn of nothing, which is none.
    return nearest_rotations(spread) @ mirror


def _edge_products(places: Floats, target: TriangleMesh) -> Floats:
    ends = target.edges.vertices
    before, after = places[ends[:, 1]] - places[ends[:, 0]], target.vertices[ends[:, 1]] - target.vertices[ends[:, 0]]
    products = (before[:, :, None] * after[:, None, :]).reshape(-1, 9)
    return _summed(np.tile(products, (2, 1)), np.concatenate([ends[:, 0], ends[:, 1]]), len(places))


def _normal_products(places: Floats, target: TriangleMesh) -> Floats:
    """Return the share of the normals: without them a flat neighbourhood could as well be turned over."""
    before, after = (area_vectors(points[target.triangles]) for points in (places, target.vertices))
    products = (unit_rows(before)[:, :, None] * after[:, None, :]).reshape(-1, 9)
    return _summed(np.repeat(products, 3, axis=0), target.triangles.ravel(), len(places))


def _summed(products: Floats, rows: Ints, n_rows: int) -> Floats:
    columns = np.tile(np.arange(9), len(rows))
    total = coo_array((products.ravel(), (np.repeat(rows, 9), columns)), shape=(n_rows, 9)).toarray()
    return total.reshape(-1, 3, 3)


def majority_of_polygons(
    labels: NDArray[np.generic], areas: Floats, polygon: Ints, n_polygons: int
) -> NDArray[np.generic]:
    """Return (F,) the label that most area of each polygon has, from those (T,) of its triangles."""
    kinds, kind = np.unique(labels, return_inverse=True)
    key, place = np.unique(polygon * len(kinds) + kind.reshape(-1), return_inverse=True)
    area = np.bincount(place.reshape(-1), np.maximum(areas, np.finfo(float).tiny))
    of_polygon, of_kind = np.divmod(key, len(kinds))
    # The last of equal polygons stays: the one with the largest area.
    order = np.lexsort((area, of_polygon))
    majority = np.zeros(n_polygons, dtype=kinds.dtype)
    majority[of_polygon[order]] = kinds[of_kind[order]]
    return majority


def islands(triangles: Ints, values: Floats) -> Ints:
    """Return (T,) the piece of each triangle that hangs together by edges over which corner values (T, 3, c) go on."""
    pairs = _continuous_pairs(triangles, values)
    return connected_pieces(pairs[:, 0], pairs[:, 1], len(triangles)).astype(np.int64)


def _continuous_pairs(triangles: Ints, values: Floats) -> Ints:
    """Return pairs of triangles that share an edge with the same values at both of its ends."""
    side = np.arange(3 * len(triangles))
    tail, head = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    at_tail, at_head = values.reshape(len(side), -1), np.roll(values, -1, axis=1).reshape(len(side), -1)
    swapped = (tail > head)[:, None]
    low, high = np.where(swapped, at_head, at_tail), np.where(swapped, at_tail, at_head)
    key = np.minimum(tail, head) * (int(triangles.max()) + 1) + np.maximum(tail, head)
    order = np.argsort(key, kind="stable")
    first, second = order[:-1], order[1:]
    close = SAME_VALUE * max(float(np.ptp(values)), 1e-300)
    same = (key[first] == key[second]) & (np.abs(low[first] - low[second]) <= close).all(axis=1)
    same &= (np.abs(high[first] - high[second]) <= close).all(axis=1)
    return np.stack([first[same], second[same]], axis=1) // 3


@told_if_full
def transfer_corners(
    correspondence: Correspondence,
    source: TriangleMesh,
    values: Floats,
    corner_vertex: Ints,
    corner_triangle: Ints,
) -> tuple[Floats, bool]:
    """Return values of the corners of the target's faces, and whether the seams between them were kept.

    Every face is looked up in one piece of the source, so that no face of the target lies across a seam; seams come to
    lie on the edges of the target next to where they were.

    Parameters
    ----------
    correspondence : Correspondence
    source : TriangleMesh
    values : (Ts, 3, c) float64
        At the corners of the source's triangles.
    corner_vertex, corner_triangle : (C,) int64
        The target's vertex at each of its corners, and a triangle of the face that the corner belongs to.

    Returns
    -------
    values : (C, c) float64
    keeps_seams : bool
    """
    island = islands(source.triangles, values)
    points = SurfacePoints(
        correspondence.triangles[corner_vertex].copy(), correspondence.barycentric[corner_vertex].copy()
    )
    keeps_seams = bool(island.max(initial=0) < MOST_ISLANDS)
    if keeps_seams:
        wanted = island[correspondence.triangle_of_triangle[corner_triangle]]
        for piece, corners in _strays(island, points, wanted):
            _move_into(points, corners, source, np.flatnonzero(island == piece))
    return np.einsum("nk,nkc->nc", points.barycentric, values[points.triangles]), keeps_seams


def _strays(island: Ints, points: SurfacePoints, wanted: Ints) -> Iterator[tuple[int, Ints]]:
    """Yield each piece with the corners that belong into it but lie outside."""
    stray = np.flatnonzero(island[points.triangles] != wanted)
    for piece in np.unique(wanted[stray]).tolist():
        yield piece, stray[wanted[stray] == piece]


def _move_into(points: SurfacePoints, corners: Ints, source: TriangleMesh, inside: Ints) -> None:
    """Move points to the nearest ones of some triangles."""
    places = SurfacePoints(points.triangles[corners], points.barycentric[corners]).blend(
        source.vertices, source.triangles
    )
    # Which way the surface looks does not matter beside a seam.
    tree = SurfaceTree(source.vertices, source.triangles[inside], turn=0.0, wrong_side=0.0)
    nearest, _ = tree.nearest(places, np.zeros_like(places), 16)
    points.triangles[corners], points.barycentric[corners] = inside[nearest.triangles], nearest.barycentric


def mixed(before: Floats, after: Floats, share: Floats | float) -> Floats:
    """Return (n, ...) values before and after, mixed by a share of the latter for all or for each row."""
    share = np.asarray(share, dtype=np.float64)
    if share.ndim:
        share = share.reshape(-1, *(1,) * (np.ndim(after) - 1))
    return before + share * (after - before)


def taken_over(share: Floats | float, n: int) -> Bools:
    """Return (n,) the rows at which labels, which cannot be mixed, are replaced: the share is at least a half."""
    return np.broadcast_to(np.asarray(share) >= 0.5, n)
