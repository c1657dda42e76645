"""Correspondence by shape: the source is bent until it lies on the target, and vertices take the nearest points.

The functional map gives rough places first, in which neighbours stay neighbours but small things are blurred.
"""

from dataclasses import dataclass

import numpy as np

from ...progress import Progress, section
from ...surface.mesh import Floats, Ints, unit_rows
from ..eigenfunctions.spectral_shape import farthest_points
from ..eigenfunctions.zoomout import nearest_rows
from .confidence import SURE, Landing, landing_confidence
from .deformation_graph import DeformationGraph, Motion, deformation_graph, motion_towards, warped
from .flipped_regions import RoughMap, with_regions_unflipped
from .nonrigid_alignment import CANDIDATES, WRONG_SIDE, Pins, Samples, aligned
from .point_map import DENSE_SAMPLES
from .shape_pair import Image, ShapePair
from .surface_points import SurfacePoints, SurfaceTree, nearest_in_triangles

# Nodes of the deformation, each for at least so many points, and points that are laid onto the target.
N_NODES = 600
POINTS_OF_NODE = 4
N_SAMPLES = 2000
# When the shapes lie on one another: candidates for the nearest point, and the distance on a surface of area 1 that a
# turn of the normal counts as.
LANDING_CANDIDATES, LANDING_TURN = 16, 0.005
# With no larger share of vertices in doubt no other start is tried.
FEW_DOUBTS = 0.02


@dataclass(frozen=True, eq=False)
class Bent:
    """The source bent onto the target: where the target's vertices come to lie on it, and how far that is trusted."""

    tree: SurfaceTree
    points: SurfacePoints
    confidence: Floats


def map_by_shape(pair: ShapePair, progress: Progress) -> Image:
    """Return the nearest points of the bent source to the vertices and to the middles of triangles of the target."""
    progress(0.0, "Mapping functions")
    rough, source = _rough_map(pair), pair.source_shape
    graph = deformation_graph(source, min(N_NODES, len(source.positions) // POINTS_OF_NODE))
    best = _best_bent(pair, graph, rough, section(progress, 0.2, 0.9))
    triangles = _middle_triangles(pair, best.tree)[pair.target.surface.triangle_of_input]
    return Image(_on_input(pair, best.points), triangles, best.confidence)


def _best_bent(pair: ShapePair, graph: DeformationGraph, rough: RoughMap, progress: Progress) -> Bent:
    """Return the source bent from the first start that leaves little in doubt, or from the one that leaves least."""
    starts = _starts(graph, rough)
    tries: list[Bent] = []
    for number, start in enumerate(starts):
        step = section(progress, number / len(starts), (number + 1) / len(starts))
        tries.append(_bent(pair, graph, start, rough.samples, step))
        if (tries[-1].confidence < SURE).mean() <= FEW_DOUBTS:
            break
    return max(tries, key=lambda bent: float(bent.confidence.mean()))


def _starts(graph: DeformationGraph, rough: RoughMap) -> list[Motion]:
    """Return the motion of a rough map; before it, if regions are flipped in it, the one in which they are not."""
    motion = _first_motion(graph, rough)
    unflipped = with_regions_unflipped(graph, motion, rough)
    return [motion] if unflipped is motion else [unflipped, motion]


def _bent(pair: ShapePair, graph: DeformationGraph, start: Motion, samples: Samples, progress: Progress) -> Bent:
    """Bend the source onto the target from a first motion, and let the vertices of the target land on it."""
    source, target, point = pair.source_shape, pair.target_shape, pair.target_points.point
    pins = Pins(pair.given.source, target.positions[pair.given.target])
    motion = aligned(graph, start, samples.first(N_SAMPLES), target, pair.target_walls.triangles, pins, progress)
    walls = pair.source_walls.triangles
    tree = SurfaceTree(warped(graph, motion), source.triangles, LANDING_TURN, WRONG_SIDE, walls)
    is_inner = pair.target_walls.points[point]
    points, gaps = tree.nearest(target.positions[point], target.normals[point], LANDING_CANDIDATES, is_inner)
    confidence = landing_confidence(pair, Landing(points, gaps, walls[points.triangles] != is_inner))
    return Bent(tree, points, np.where(pair.target_points.is_analyzed, confidence, 0.0))


def _rough_map(pair: ShapePair) -> RoughMap:
    """Return where the functional map brings the samples of the source."""
    source, target = pair.source_shape, pair.target_shape
    target_samples = farthest_points(target.positions, DENSE_SAMPLES)
    source_rows, target_rows = pair.embedded(pair.samples, target_samples)
    point = target_samples[nearest_rows(source_rows, target_rows)]
    samples = Samples(pair.samples, source.normals[pair.samples], pair.source_walls.points[pair.samples])
    return RoughMap(samples, target.positions[point], target.normals[point])


def _first_motion(graph: DeformationGraph, rough: RoughMap) -> Motion:
    """Return the motion that shifts each node by the mean of the shifts of the samples around it."""
    points = rough.samples.points
    weights, node = graph.weights[points], graph.followed[points]
    n_nodes = len(graph.nodes)
    total = np.bincount(node.ravel(), weights.ravel(), n_nodes)
    shift = np.repeat(rough.places - graph.points[points], node.shape[1], axis=0) * weights.ravel()[:, None]
    sums = np.stack([np.bincount(node.ravel(), column, n_nodes) for column in shift.T], axis=1)
    return motion_towards(graph, graph.nodes + sums / np.maximum(total, 1e-9)[:, None])


def _on_input(pair: ShapePair, points: SurfacePoints) -> SurfacePoints:
    """Return points on the net of the source as points on its input triangles."""
    mesh, shape = pair.source.mesh, pair.source_shape
    nodes = pair.source.matching_basis.nodes[shape.node]
    places = points.blend(nodes, shape.triangles)
    triangles = shape.input_triangle[points.triangles]
    barycentric = nearest_in_triangles(places, mesh.vertices[mesh.triangles[triangles]])[0]
    return SurfacePoints(triangles, barycentric)


def _middle_triangles(pair: ShapePair, tree: SurfaceTree) -> Ints:
    """Return the source's input triangle at the middle of each of the target's analyzed triangles."""
    target = pair.target_shape
    corners = pair.target_points.point[pair.target.surface.mesh.triangles]
    normals = unit_rows(target.normals[corners].mean(axis=1))
    places, is_inner = target.positions[corners].mean(axis=1), pair.target_walls.of_surface
    nearest, _ = tree.nearest(places, normals, CANDIDATES, is_inner)
    return pair.source_shape.input_triangle[nearest.triangles]
