"""How far the place of a vertex can be trusted: from gaps, stretch, flips and walls, and from what surrounds it."""

from dataclasses import dataclass

import numpy as np

from ...surface.heat_smoothing import smoothed
from ...surface.mesh import Bools, Floats, TriangleMesh, area_vectors, sum_by
from .shape_pair import ShapePair
from .surface_points import SurfacePoints

# Below this confidence a vertex is better filled in from its neighbours.
SURE = 0.5
# Each of these halves the confidence: a gap between the shapes, on a surface of area 1; a stretch of the edges around a
# vertex; a share of the triangles around it that are turned over.
DOUBTFUL_GAP = 0.02
DOUBTFUL_STRETCH = 2.5
DOUBTFUL_FLIPS = 0.5
# Who has mostly doubtful vertices around is doubted, too: the mean over about this width on a surface of area 1.
SURROUNDINGS = 0.2


@dataclass(frozen=True, eq=False)
class Landing:
    """Where the vertices of a target (Vt,) come to lie on the net of a source.

    Attributes
    ----------
    points : SurfacePoints
        On the triangles of the source's shape.
    gaps : (Vt,) float64
        Distance to the bent source, on a surface of area 1.
    on_other_wall : (Vt,) bool
        Whether an inner vertex lies on an outer wall or the other way round.
    """

    points: SurfacePoints
    gaps: Floats
    on_other_wall: Bools


def landing_confidence(pair: ShapePair, landing: Landing) -> Floats:
    """Return (Vt,) the confidence, from 0 to 1, in the places of the target's vertices."""
    mesh, surface = pair.target.surface.mesh, pair.target.surface
    places = landing.points.blend(pair.source_shape.positions, pair.source_shape.triangles)
    positions = pair.target_shape.positions[pair.target_points.point]
    doubt = (landing.gaps / DOUBTFUL_GAP) ** 2
    doubt += (_stretch(mesh, positions, places) / np.log(DOUBTFUL_STRETCH)) ** 4
    doubt += (_flipped_share(pair, landing, places) / DOUBTFUL_FLIPS) ** 2
    confidence = np.where(landing.on_other_wall, 0.0, 1 / (1 + doubt))
    doubted = np.zeros(len(confidence))
    doubted[mesh.used] = confidence[mesh.used] < SURE
    around = smoothed(mesh, doubted[:, None], SURROUNDINGS * np.sqrt(mesh.areas.sum()))[:, 0]
    # Doubles of a vertex share its edges.
    return np.minimum(confidence, 1 - np.clip(around, 0, 1))[surface.vertex_of_input]


def _stretch(mesh: TriangleMesh, positions: Floats, places: Floats) -> Floats:
    """Return (V,) the logarithm of how much longer or shorter the edges around a vertex have become, without sign."""
    ends, n_vertices = mesh.edges.vertices, len(positions)
    before, after = (
        np.bincount(ends.ravel(), np.repeat(_lengths(points[ends[:, 1]] - points[ends[:, 0]]), 2), n_vertices)
        for points in (positions, places)
    )
    tiny = np.finfo(float).tiny
    stretch = np.abs(np.log(np.maximum(after, tiny) / np.maximum(before, tiny)))
    return np.where(before > 0, stretch, 0.0)


def _flipped_share(pair: ShapePair, landing: Landing, places: Floats) -> Floats:
    """Return (V,) the share of the area around a vertex whose triangles look into the source where they land."""
    triangles, shapes = pair.target.surface.mesh.triangles, (pair.target_shape, pair.source_shape)
    normals = shapes[1].normals[shapes[1].triangles]
    landed = np.einsum("nk,nkj->nj", landing.points.barycentric, normals[landing.points.triangles])
    point = pair.target_points.point[triangles]
    before = area_vectors(shapes[0].positions[point])
    looks_out = (before * shapes[0].normals[point].sum(axis=1)).sum(axis=1) > 0
    looks_out_there = (area_vectors(places[triangles]) * landed[triangles].sum(axis=1)).sum(axis=1) > 0
    area, n_vertices = np.repeat(_lengths(before), 3), len(places)
    flipped = sum_by(triangles.ravel(), area * np.repeat(looks_out != looks_out_there, 3), n_vertices)
    return flipped / np.maximum(sum_by(triangles.ravel(), area, n_vertices), np.finfo(float).tiny)


def _lengths(vectors: Floats) -> Floats:
    return np.linalg.norm(vectors, axis=1)
