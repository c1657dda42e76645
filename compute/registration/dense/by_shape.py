"""Correspondence by shape: the source is bent until it lies on the target, and vertices take the nearest points.

The functional map gives rough places first, in which neighbours stay neighbours but small things are blurred.
"""

import numpy as np

from ...progress import Progress, section
from ...surface.mesh import Floats, Ints
from ..eigenfunctions.spectral_shape import farthest_points
from ..eigenfunctions.zoomout import nearest_rows
from .confidence import Landing, landing_confidence
from .deformation_graph import DeformationGraph, Motion, deformation_graph, motion_towards, warped
from .flipped_regions import RoughMap, with_regions_unflipped
from .nonrigid_alignment import CANDIDATES, WRONG_SIDE, Samples, aligned
from .point_map import DENSE_SAMPLES
from .shape_pair import Image, ShapePair
from .surface_points import SurfacePoints, SurfaceTree, nearest_in_triangles, unit_rows

# Nodes of the deformation, each for at least so many points, and points that are laid onto the target.
N_NODES = 600
POINTS_OF_NODE = 4
N_SAMPLES = 2000
# When the shapes lie on one another: candidates for the nearest point, and the distance on a surface of area 1 that a
# turn of the normal counts as.
LANDING_CANDIDATES, LANDING_TURN = 16, 0.005


def map_by_shape(pair: ShapePair, progress: Progress) -> Image:
    """Return the nearest points of the bent source to the vertices and to the middles of triangles of the target."""
    progress(0.0, "Mapping functions")
    rough = _rough_map(pair)
    bent_source = _bent_source(pair, rough, section(progress, 0.2, 0.8))
    progress(0.8, "Finding the nearest points")
    tree = SurfaceTree(bent_source, pair.source_shape.triangles, LANDING_TURN, WRONG_SIDE, pair.source_walls.triangles)
    target, point = pair.target_shape, pair.target_points.point
    is_inner = pair.target_walls.points[point]
    net_points, gaps = tree.nearest(target.positions[point], target.normals[point], LANDING_CANDIDATES, is_inner)
    landing = Landing(net_points, gaps, pair.source_walls.triangles[net_points.triangles] != is_inner)
    confidence = np.where(pair.target_points.is_analyzed, landing_confidence(pair, landing), 0.0)
    triangles = _middle_triangles(pair, tree)[pair.target.surface.triangle_of_input]
    return Image(_on_input(pair, net_points), triangles, confidence)


def _bent_source(pair: ShapePair, rough: RoughMap, progress: Progress) -> Floats:
    """Return (n, 3) the points of the source's shape after it is bent onto the target from a rough map."""
    source = pair.source_shape
    graph = deformation_graph(source, min(N_NODES, len(source.positions) // POINTS_OF_NODE))
    motion = with_regions_unflipped(graph, _first_motion(graph, rough), rough)
    samples, is_inner = rough.samples.first(N_SAMPLES), pair.target_walls.triangles
    return warped(graph, aligned(graph, motion, samples, pair.target_shape, is_inner, progress))


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
