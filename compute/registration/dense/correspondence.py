"""The dense map: for each vertex of a target the point of the source that it corresponds to.

The matched functions give a rough map (`dense`), in which neighbours stay neighbours but small things are blurred. The
source is then bent until it lies on the target (`alignment`), and each vertex takes the nearest point of it. Where both
have the same faces, under whatever numbers, vertices correspond exactly.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from ...analysis import Analysis
from ...errors import RegistrationError
from ...progress import Progress, rising, section, silent
from ...surface.cleaning import Surface
from ...surface.mesh import Bools, Floats, Ints
from ...surface.orientation import reversed_where, wrongly_wound
from ...surface.ties import first_largest
from ..eigenfunctions.matching import Matching, match_surfaces
from ..eigenfunctions.spectral_shape import SpectralShape, farthest_points, spectral_shape
from ..eigenfunctions.zoomout import nearest_rows
from .deformation_graph import DeformationGraph, Motion, deformation_graph, motion_towards, warped
from .matched_points import DENSE_SAMPLES, dense_map
from .nonrigid_alignment import CANDIDATES, TURN, aligned
from .renumbering import may_be_renumbered, renumbering
from .surface_points import SurfacePoints, SurfaceTree, nearest_in_triangles, unit_rows

# Nodes of the deformation, each for at least so many points, and points that are laid onto the target.
N_NODES = 600
POINTS_OF_NODE = 4
N_SAMPLES = 2000
# When the shapes lie on one another: candidates for the nearest point, and what a turn of the normal and a wrong side
# count as, on a surface of area 1.
LANDING_CANDIDATES, LANDING_TURN, WRONG_SIDE = 16, 0.005, 0.03
# A gap of this size between the shapes, on a surface of area 1, halves the confidence; so does this stretch of an edge.
DOUBTFUL_GAP = 0.02
DOUBTFUL_STRETCH = 2.5
# Below this confidence a vertex is better filled in from its neighbours.
SURE = 0.5

BY_NUMBER, BY_FACES, BY_SHAPE = "number", "faces", "shape"


@dataclass(frozen=True, eq=False)
class Correspondence:
    """Where on a source (Vs vertices, Ts triangles) everything of a target (Vt, Tt) belongs.

    Attributes
    ----------
    triangles : (Vt,) int64
        Triangle of the source for each vertex of the target.
    barycentric : (Vt, 3) float64
        Where in that triangle; sums to 1.
    triangle_of_triangle : (Tt,) int64
        The source's triangle at the middle of each of the target's.
    confidence : (Vt,) float64
        From 0 to 1: high where the shapes came to lie on one another without much stretch; 0 on loose parts that were
        not analyzed, which follow the nearest vertex in space that was.
    matching : Matching
        What it was made from.
    found_by : str
        "number" where both meshes have the same triangles, so that vertices correspond by their numbers; "faces" where
        they do under other numbers; "shape" otherwise.
    source_triangles : (Ts, 3) int64
    """

    triangles: Ints
    barycentric: Floats
    triangle_of_triangle: Ints
    confidence: Floats
    matching: Matching
    found_by: str
    source_triangles: Ints

    @cached_property
    def is_sure(self) -> Bools:
        """(Vt,) the vertices whose place can be trusted."""
        return self.confidence >= SURE

    @cached_property
    def nearest_vertex(self) -> Ints:
        """(Vt,) the vertex of the source next to each place."""
        return _nearest_corner(self.points, self.source_triangles)

    def transfer(self, values: ArrayLike) -> Floats:
        """Return (Vt, ...) values (Vs, ...) of the source's vertices on the target's, linear on each triangle."""
        given = np.asarray(values, dtype=np.float64)
        return self.points.blend(given, self.source_triangles)

    def transfer_labels(self, labels: ArrayLike) -> NDArray[np.generic]:
        """Return (Vt, ...) what the nearest vertex of the source has, for values that cannot be blended."""
        return np.asarray(labels)[self.nearest_vertex]

    def transfer_faces(self, labels: ArrayLike) -> NDArray[np.generic]:
        """Return (Tt, ...) what the source's triangle at the middle of each triangle has."""
        return np.asarray(labels)[self.triangle_of_triangle]

    @property
    def points(self) -> SurfacePoints:
        """The places of the vertices."""
        return SurfacePoints(self.triangles, self.barycentric)


def correspond(
    source: Analysis, target: Analysis, *, matching: Matching | None = None, progress: Progress | None = None
) -> Correspondence:
    """Find for each vertex of a target the point of the source that it corresponds to.

    Parameters
    ----------
    source, target : Analysis
    matching : Matching, optional
        Of the two; found now if None.
    progress : callable, optional
        ``progress(fraction, text)``; may raise `Cancelled`.

    Raises
    ------
    RegistrationError
        If the matching is for other shapes.

    References
    ----------
    .. [1] Melzi et al., "ZoomOut: Spectral Upsampling for Efficient Shape Correspondence", SIGGRAPH Asia 2019.
    .. [2] Sumner, Schmid, Pauly, "Embedded Deformation for Shape Manipulation", SIGGRAPH 2007.
    """
    progress = rising(progress or silent)
    progress(0.0, "Computing functions")
    shapes = spectral_shape(source.matching_basis), spectral_shape(target.matching_basis)
    if matching is None:
        progress(0.3, "Matching")
        matching = match_surfaces(source.surface, target.surface, *shapes)
    if matching.same_topology:
        return _by_number(source, target, matching)
    _check(matching, *shapes)
    here = shapes[0].mirrored() if matching.mirrored else shapes[0]
    return _by_shape(_Pair(source, target, here, shapes[1], matching), section(progress, 0.5, 1.0))


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two analyzed shapes, the source mirrored if it is matched so."""

    source: Analysis
    target: Analysis
    here: SpectralShape
    there: SpectralShape
    matching: Matching


def _check(matching: Matching, source: SpectralShape, target: SpectralShape) -> None:
    n_target, n_source = matching.map.shape
    if n_target >= target.n_functions or n_source >= source.n_functions:
        raise RegistrationError("The matching is for other shapes than these two.")


def _by_number(source: Analysis, target: Analysis, matching: Matching) -> Correspondence:
    """Return the map of vertices by their numbers; what has no triangles takes the nearest vertex that has."""
    triangles = target.mesh.triangles
    of_vertex, corner = _any_triangle(triangles, len(target.mesh.vertices))
    is_used = of_vertex >= 0
    known = _nearest_known(target.mesh.vertices, is_used)
    found = SurfacePoints(of_vertex[known], np.eye(3)[corner[known]])
    same_triangles, confidence = np.arange(len(triangles)), is_used.astype(np.float64)
    return Correspondence(
        found.triangles, found.barycentric, same_triangles, confidence, matching, BY_NUMBER, source.mesh.triangles
    )


def _nearest_known(vertices: Floats, is_known: Bools) -> Ints:
    """Return for each vertex (V, 3) itself or, if it is not known, the nearest in space that is."""
    nearest = np.arange(len(vertices))
    lone = np.flatnonzero(~is_known)
    if len(lone):
        known = np.flatnonzero(is_known)
        # Vertices without faces may lie nowhere.
        nearest[lone] = known[cKDTree(vertices[known]).query(np.nan_to_num(vertices[lone]))[1]]
    return nearest


def _any_triangle(triangles: Ints, n_vertices: int) -> tuple[Ints, Ints]:
    """Return for each vertex a triangle around it, -1 if there is none, and which of its corners it is."""
    side = np.full(n_vertices, -3)
    side[triangles.ravel()] = np.arange(triangles.size)
    return side // 3, side % 3


def _by_shape(pair: _Pair, progress: Progress) -> Correspondence:
    progress(0.0, "Mapping functions")
    row, is_analyzed = _rows(pair.target, pair.there)
    samples = farthest_points(pair.here.positions, DENSE_SAMPLES)
    grown = dense_map(pair.here, pair.there, pair.matching, samples)
    progress(0.2, "Comparing the faces")
    image = _same_faces(pair, grown, row)
    if image is not None:
        return _by_faces(pair, image, is_analyzed)
    laid = _laid_onto(pair, samples, _rough_places(pair, samples, grown), section(progress, 0.2, 0.8))
    progress(0.8, "Finding the nearest points")
    tree = SurfaceTree(laid, pair.here.triangles, LANDING_TURN, WRONG_SIDE)
    net_points, gaps = tree.nearest(pair.there.positions[row], pair.there.normals[row], LANDING_CANDIDATES)
    found = _on_input(pair, net_points)
    confidence = np.where(is_analyzed, _confidence(pair, found, gaps, row), 0.0)
    return _correspondence(pair, found, _middles(pair, tree, row), confidence, BY_SHAPE)


def _correspondence(pair: _Pair, found: SurfacePoints, middles: Ints, confidence: Floats, how: str) -> Correspondence:
    triangle_of_triangle = middles[pair.target.surface.triangle_of_input]
    source_triangles = pair.source.mesh.triangles
    return Correspondence(
        found.triangles, found.barycentric, triangle_of_triangle, confidence, pair.matching, how, source_triangles
    )


def _laid_onto(pair: _Pair, samples: Ints, places: Floats, progress: Progress) -> Floats:
    """Return (n, 3) where the points of the source's shape lie when it is bent onto the target."""
    here, there = pair.here, pair.there
    graph = deformation_graph(here, min(N_NODES, len(here.positions) // POINTS_OF_NODE))
    tree = SurfaceTree(there.positions, there.triangles, TURN, WRONG_SIDE)
    motion = _first_motion(graph, samples, places)
    chosen = samples[:N_SAMPLES]
    surface = (there.positions, there.normals, there.triangles)
    return warped(graph, aligned(graph, motion, chosen, here.normals[chosen], tree, surface, progress))


def _rough_places(pair: _Pair, samples: Ints, grown: Floats) -> Floats:
    """Return where on the target the functional map has samples of the source."""
    others = farthest_points(pair.there.positions, DENSE_SAMPLES)
    here, there = _embeddings(pair, samples, others, grown)
    return pair.there.positions[others[nearest_rows(here, there)]]


def _embeddings(pair: _Pair, here: Ints, there: Ints, grown: Floats) -> tuple[Floats, Floats]:
    """Return points of both shapes in the space where the functional map makes them comparable."""
    n_target, n_source = grown.shape
    return pair.here.functions[here, :n_source] @ grown.T, pair.there.functions[there, :n_target]


def _first_motion(graph: DeformationGraph, samples: Ints, places: Floats) -> Motion:
    """Return the motion that brings the nodes to the mean of where the samples around them go."""
    weights, node = graph.weights[samples], graph.followed[samples]
    n_nodes = len(graph.nodes)
    total = np.bincount(node.ravel(), weights.ravel(), n_nodes)
    way = np.repeat(places - graph.points[samples], node.shape[1], axis=0) * weights.ravel()[:, None]
    sums = np.stack([np.bincount(node.ravel(), column, n_nodes) for column in way.T], axis=1)
    return motion_towards(graph, graph.nodes + sums / np.maximum(total, 1e-9)[:, None])


def _rows(analysis: Analysis, shape: SpectralShape) -> tuple[Ints, Bools]:
    """Return for each vertex of the input its point of the shape, or that of the nearest vertex in space that has one.

    The second array tells which vertices are on the shape.
    """
    vertices = analysis.mesh.vertices
    row = np.full(len(vertices), -1)
    is_vertex = shape.node < len(vertices)
    row[shape.node[is_vertex]] = np.flatnonzero(is_vertex)
    row = row[analysis.surface.vertex_of_input]
    is_analyzed = row >= 0
    return row[_nearest_known(vertices, is_analyzed)], is_analyzed


def _on_input(pair: _Pair, points: SurfacePoints) -> SurfacePoints:
    """Return points on the net of the source as points on its input triangles."""
    mesh, shape = pair.source.mesh, pair.here
    nodes = pair.source.matching_basis.nodes[shape.node]
    places = points.blend(nodes, shape.triangles)
    triangles = shape.input_triangle[points.triangles]
    barycentric = nearest_in_triangles(places, mesh.vertices[mesh.triangles[triangles]])[0]
    return SurfacePoints(triangles, barycentric)


def _middles(pair: _Pair, tree: SurfaceTree, row: Ints) -> Ints:
    """Return the source's input triangle at the middle of each of the target's analyzed triangles."""
    corners = row[pair.target.surface.mesh.triangles]
    normals = unit_rows(pair.there.normals[corners].mean(axis=1))
    found, _ = tree.nearest(pair.there.positions[corners].mean(axis=1), normals, CANDIDATES)
    return pair.here.input_triangle[found.triangles]


def _confidence(pair: _Pair, found: SurfacePoints, gaps: Floats, row: Ints) -> Floats:
    """Return (Vt,) from the gap to the bent source, and from how much the edges around a vertex are stretched."""
    source, target = pair.source.mesh, pair.target.surface.mesh
    places = found.blend(source.vertices, source.triangles) / np.sqrt(pair.source.surface.mesh.areas.sum())
    ends = target.edges.vertices
    before, after = (
        np.bincount(ends.ravel(), np.repeat(_lengths(positions, ends), 2), len(row))
        for positions in (places, pair.there.positions[row])
    )
    tiny = np.finfo(float).tiny
    stretch = np.abs(np.log(np.maximum(before, tiny) / np.maximum(after, tiny))) / np.log(DOUBTFUL_STRETCH)
    confidence = 1 / (1 + (gaps / DOUBTFUL_GAP) ** 2 + np.where(after > 0, stretch, 0.0) ** 4)
    # Doubles of a vertex share its edges.
    return confidence[pair.target.surface.vertex_of_input]


def _lengths(positions: Floats, ends: Ints) -> Floats:
    return np.linalg.norm(positions[ends[:, 0]] - positions[ends[:, 1]], axis=1)


def _same_faces(pair: _Pair, grown: Floats, row: Ints) -> Ints | None:
    """Return (Vt,) the source's vertex that each analyzed vertex is, if the faces are the same; None otherwise."""
    here, there = _wound(pair.source.surface), _wound(pair.target.surface)
    if not may_be_renumbered(here, there):
        return None
    if pair.matching.mirrored:
        here = here[:, ::-1]
    source_row, is_vertex = _rows(pair.source, pair.here)
    vertices = np.flatnonzero(is_vertex)
    rows, places = _embeddings(pair, source_row[vertices], row, grown)
    guess = pair.source.surface.vertex_of_input[vertices[nearest_rows(places, rows)]]
    return renumbering(here, there, len(source_row), len(row), guess)


def _wound(surface: Surface) -> Ints:
    return reversed_where(surface.mesh.triangles, wrongly_wound(surface.mesh))


def _nearest_corner(points: SurfacePoints, triangles: Ints) -> Ints:
    return triangles[points.triangles, first_largest(points.barycentric)]


def _by_faces(pair: _Pair, image: Ints, is_analyzed: Bools) -> Correspondence:
    """Return the map of vertices that are the same under other numbers."""
    source, target = pair.source, pair.target
    vertex = image[target.surface.vertex_of_input][_nearest_known(target.mesh.vertices, is_analyzed)]
    of_vertex, corner = _any_triangle(source.mesh.triangles, len(source.mesh.vertices))
    found = SurfacePoints(of_vertex[vertex], np.eye(3)[corner[vertex]])
    middles = source.surface.input_triangle[
        _matching_rows(source.surface.mesh.triangles, image[target.surface.mesh.triangles])
    ]
    return _correspondence(pair, found, middles, is_analyzed.astype(np.float64), BY_FACES)


def _matching_rows(triangles: Ints, wanted: Ints) -> Ints:
    """Return for each wanted triangle the row with the same corners, in whatever order."""
    rows, other = np.sort(triangles, axis=1), np.sort(wanted, axis=1)
    match = np.empty(len(wanted), dtype=np.int64)
    match[np.lexsort(other.T)] = np.lexsort(rows.T)
    return match
