"""Layers mapped from one shape to others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import compute
from . import layers, recent_analyses
from .layers import Layer
from .match_options import MatchOptions
from .mesh_shape import MeshArrays
from .recent_results import Recent, key_of
from .refusals import Refusal, in_name_of
from .shared_calls import run_all

# What an analysis needs for matching.
JUST_ENOUGH = {"n_functions": 2, "order": 1}
# Vertices of all maps that are kept; each takes a tenth of a kB.
RECENT_VERTICES = 200_000
# Parts of which no larger share than this is unsure are not named.
FEW_UNSURE = 0.05
# It is told if more than this share of a target does not lie on the source that it was taken from by place.
MUCH_UNSURE = 0.2
# A matching this unsure is none.
NO_MATCH = 0.03
NOT_ALIKE = (
    "{} and {} are not alike enough to be matched (confidence {:.0%}); nothing was transferred. If one is the mirror"
    " image of the other, choose Mirrored; if it lies on the other, as clothes on a body do, choose By Place."
)
NOT_IN_PLACE = "{} does not lie on {} anywhere; nothing was transferred. Put it there, or choose By Shape."
LED_BY_PLACE = "Points and Mirrored are for transfers by shape; choose By Shape, or take them back."
FAR = "Loose parts of {} that lie nowhere on {}: {}; they are given what is nearest."
NOT_ALL_THERE = "{:.0%} of {} does not lie on {}; if it stands in another pose, bring both into the same."

_recent_maps: Recent[ShapeMap] = Recent("maps", RECENT_VERTICES)


@dataclass(frozen=True, eq=False)
class ShapeParts:
    """The parts that a mesh shows.

    Attributes
    ----------
    of_polygon : (F,) int32
        Number of the part of each face.
    names : dict of int to str
        Of each that it shows.
    """

    of_polygon: NDArray[np.int32]
    names: Mapping[int, str]


@dataclass(frozen=True, eq=False)
class TransferShape:
    """A mesh that layers come from or go to.

    Attributes
    ----------
    name : str
        Of the object.
    arrays : MeshArrays
    corners : (T, 3) int64
        The corner of a face that each corner of a triangle is.
    corner_vertex, corner_polygon : (C,) int64
        Vertex and face of each corner.
    to_world : (4, 4) float64
        From the shape to where the object stands.
    options : MatchOptions
        How a target is matched with the source.
    unfinished : str
        What is told of its modifiers if it is not matched well; empty if none of them adds to it.
    parts : ShapeParts, optional
    """

    name: str
    arrays: MeshArrays
    corners: NDArray[np.int64]
    corner_vertex: NDArray[np.int64]
    corner_polygon: NDArray[np.int64]
    to_world: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    options: MatchOptions = field(default_factory=MatchOptions)
    unfinished: str = ""
    parts: ShapeParts | None = None

    @property
    def mesh(self) -> compute.TriangleMesh:
        """The triangles as the engine takes them."""
        return compute.TriangleMesh(self.arrays.vertices, self.arrays.triangles)

    @property
    def mesh_in_world(self) -> compute.TriangleMesh:
        """The triangles where the object stands."""
        vertices = self.arrays.vertices @ self.to_world[:3, :3].T + self.to_world[:3, 3]
        return compute.TriangleMesh(vertices, self.arrays.triangles)


@dataclass(frozen=True, eq=False)
class ShapeMap:
    """The map from a target to the source, with what their analyses warn of.

    Attributes
    ----------
    correspondence : Correspondence
    place_of_vertex : (V,) int64
        The vertex of the target that stands for each where several lie at one place along a seam.
    source_warnings, target_warnings : tuple of str
    """

    correspondence: compute.Correspondence
    place_of_vertex: NDArray[np.int64]
    source_warnings: tuple[str, ...]
    target_warnings: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class MappedLayers:
    """The layers that one target gets.

    Attributes
    ----------
    layers : list of Layer
    is_sure : (V,) bool
    found_by : str
        "number", "faces", "place" or "shape".
    confidence : float
        Of the matching; by place the share of the vertices that lies on the source.
    unsure_parts : dict of str to float
        The share of its vertices that is unsure, for each part of the target, or of the source if the target has none,
        where it is more than `FEW_UNSURE`; the largest first.
    torn_seams : tuple of str
        Layers whose seams could not be kept.
    warnings : tuple of str
        Of the two analyses, beginning with the names of the objects.
    unfinished : tuple of str
        What is told of modifiers where the matching is not sure.
    """

    layers: list[Layer]
    is_sure: NDArray[np.bool_]
    found_by: str
    confidence: float
    unsure_parts: Mapping[str, float]
    torn_seams: tuple[str, ...]
    warnings: tuple[str, ...] = ()
    unfinished: tuple[str, ...] = ()


def map_to_all(
    source: TransferShape,
    given: list[Layer],
    targets: list[TransferShape],
    progress: compute.Progress,
    *,
    fills: bool,
    method: str = "auto",
) -> list[MappedLayers]:
    """Return the layers that each target gets.

    Parameters
    ----------
    method : str
        "auto", "place" or "shape", as in `correspond`.
    fills : bool
        Whether unsure vertices are filled in from their neighbours.
    """
    targets = [_split_alike(source, target) for target in targets]
    maps = _recall_maps(source, targets, method, progress)
    return [_mapped(shape_map, source, target, given, fills) for shape_map, target in zip(maps, targets, strict=True)]


def _recall_maps(
    source: TransferShape, targets: list[TransferShape], method: str, progress: compute.Progress
) -> list[ShapeMap]:
    """Return the maps to all targets; those that were found for other layers before are at hand."""
    placing, shaping = compute.section(progress, 0, 0.05), compute.section(progress, 0.05, 1)
    by_place = run_all(_map_by_place, [(source, target, method) for target in targets], placing)
    keys = [_key_of_map(source, target) for target in targets]
    known = {key: found for key in keys if (found := _recent_maps.get(key)) is not None}
    missing = {
        key: target
        for key, target, placed in zip(keys, targets, by_place, strict=True)
        if placed is None and key not in known
    }
    if missing:
        known |= _maps_by_shape(source, missing, shaping)
    return [placed or known[key] for key, placed in zip(keys, by_place, strict=True)]


def _map_by_place(
    source: TransferShape, target: TransferShape, method: str, progress: compute.Progress
) -> ShapeMap | None:
    """Return the map by place, None if another is wanted."""
    options = target.options
    is_led = options.mirrored or options.points.vertices or options.flips or options.alternative
    is_copy = np.array_equal(source.arrays.triangles, target.arrays.triangles)
    if method == "shape" or (method == "auto" and (is_led or is_copy)):
        return None
    if options.mirrored or options.points.vertices:
        raise Refusal(LED_BY_PLACE)
    progress = compute.naming(progress, target.name)
    progress(0.0, "Looking for the nearest points")
    meshes = _mesh_in_world(source), _mesh_in_world(target)
    correspondence = compute.correspond_by_place(*meshes)
    if method == "auto" and not compute.lie_together(*meshes, correspondence.points, correspondence.is_sure):
        return None
    if not correspondence.is_sure.any():
        raise Refusal(" ".join([NOT_IN_PLACE.format(target.name, source.name), *_unfinished(source, target)]))
    return ShapeMap(correspondence, compute.welded_vertices(meshes[1]), (), ())


def _mesh_in_world(shape: TransferShape) -> compute.TriangleMesh:
    with in_name_of(shape.name):
        return shape.mesh_in_world


def _maps_by_shape(
    source: TransferShape, targets: Mapping[str, TransferShape], progress: compute.Progress
) -> dict[str, ShapeMap]:
    # All are analyzed first: what cannot be is told before the longer part begins.
    first, others, mapping = (compute.section(progress, *ends) for ends in ((0, 0.1), (0.1, 0.3), (0.3, 0.95)))
    of_source = _analyze(source, recent_analyses.recall, first)
    analyses = run_all(_analyze, [(target, recent_analyses.reuse) for target in targets.values()], others)
    pairs = [
        (key, source, target, of_source, analysis)
        for (key, target), analysis in zip(targets.items(), analyses, strict=True)
    ]
    return dict(zip(targets, run_all(_new_map, pairs, mapping), strict=True))


def _new_map(
    key: str,
    source: TransferShape,
    target: TransferShape,
    of_source: compute.Analysis,
    of_target: compute.Analysis,
    progress: compute.Progress,
) -> ShapeMap:
    correspondence = _correspond(source, target, of_source, of_target, compute.naming(progress, target.name))
    places = of_target.surface.vertex_of_input
    new = ShapeMap(correspondence, places, of_source.warnings, of_target.warnings)
    _recent_maps.put(key, new, len(target.arrays.vertices))
    return new


def _key_of_map(source: TransferShape, target: TransferShape) -> str:
    places = [array for shape in (source, target) for array in (shape.arrays.vertices, shape.arrays.triangles)]
    options = target.options
    return key_of(
        [*places, options.mirrored, sorted(options.flips.items()), options.alternative, *options.points.vertices]
    )


def _split_alike(source: TransferShape, target: TransferShape) -> TransferShape:
    """Return a target with the triangles of the source where the faces are the same: poses may split quads apart."""
    alike = (
        len(source.arrays.vertices) == len(target.arrays.vertices)
        and np.array_equal(source.corner_vertex, target.corner_vertex)
        and np.array_equal(source.corner_polygon, target.corner_polygon)
    )
    if not alike:
        return target
    # What is mirrored in the world has its corners turned round already.
    turned = source.arrays.stretch.mirrors != target.arrays.stretch.mirrors
    triangles = target.corner_vertex[source.corners[:, [0, 2, 1]] if turned else source.corners]
    polygons = source.arrays.polygon_of_triangle
    return replace(target, arrays=replace(target.arrays, triangles=triangles, polygon_of_triangle=polygons))


def _analyze(
    shape: TransferShape, analysis_of: Callable[..., compute.Analysis], progress: compute.Progress
) -> compute.Analysis:
    """Return an analysis that is just enough for matching."""
    with in_name_of(shape.name):
        return analysis_of(shape.arrays, JUST_ENOUGH, compute.naming(progress, shape.name))


def _correspond(
    source: TransferShape,
    target: TransferShape,
    source_analysis: compute.Analysis,
    target_analysis: compute.Analysis,
    progress: compute.Progress,
) -> compute.Correspondence:
    options = target.options
    matching = compute.match(
        source_analysis,
        target_analysis,
        points=options.points.vertices,
        flips=dict(options.flips),
        mirrored=options.mirrored,
        progress=compute.section(progress, 0, 0.5),
    )
    choices = (matching, *matching.alternatives)
    matching = choices[options.alternative % len(choices)]
    if matching.confidence < NO_MATCH:
        not_alike = NOT_ALIKE.format(source.name, target.name, matching.confidence)
        raise Refusal(" ".join([not_alike, *options.point_warnings(matching), *_unfinished(source, target)]))
    return compute.correspond(
        source_analysis, target_analysis, matching=matching, progress=compute.section(progress, 0.5, 1)
    )


def _mapped(
    shape_map: ShapeMap, source: TransferShape, target: TransferShape, given: list[Layer], fills: bool
) -> MappedLayers:
    correspondence = shape_map.correspondence
    mapper, matching = _LayerMapper(shape_map, source, target), correspondence.matching
    mapped = [mapper.map(layer) for layer in given]
    if fills and not correspondence.is_sure.all():
        mapped = mapper.filled_together([mapper.filled(layer) for layer in mapped], mapped)
    return MappedLayers(
        layers=mapped,
        is_sure=correspondence.is_sure,
        found_by=correspondence.found_by,
        confidence=correspondence.overlap if matching is None else float(matching.confidence),
        unsure_parts=_unsure_parts(mapper, source, target, ~correspondence.is_sure),
        torn_seams=tuple(mapper.torn_seams),
        warnings=(
            *(f"{source.name}: {warning}" for warning in shape_map.source_warnings),
            *(f"{target.name}: {warning}" for warning in shape_map.target_warnings),
            *(f"{target.name}: {warning}" for warning in target.options.point_warnings(matching)),
            *mapper.doubts_by_place(),
        ),
        unfinished=_unfinished(source, target),
    )


def _unfinished(*shapes: TransferShape) -> tuple[str, ...]:
    """Return a sentence about each shape whose modifiers add to it."""
    return tuple(shape.unfinished for shape in shapes if shape.unfinished)


def _unsure_parts(
    mapper: _LayerMapper, source: TransferShape, target: TransferShape, is_unsure: NDArray[np.bool_]
) -> dict[str, float]:
    parts = target.parts or source.parts
    if parts is None or not is_unsure.any():
        return {}
    of_polygon = parts.of_polygon if parts is target.parts else mapper.faces(parts.of_polygon)
    of_corner, vertex = of_polygon[target.corner_polygon], target.corner_vertex
    part, first = np.unique(of_corner.astype(np.int64) * len(is_unsure) + vertex, return_index=True)
    part, unsure = part // len(is_unsure), is_unsure[vertex[first]]
    share = np.bincount(part, unsure) / np.maximum(np.bincount(part), 1)
    unsure_parts = [int(number) for number in np.argsort(-share, kind="stable") if share[number] > FEW_UNSURE]
    return {parts.names[number]: float(share[number]) for number in unsure_parts}


class _LayerMapper:
    """Maps layers from one mesh to another."""

    def __init__(self, shape_map: ShapeMap, source: TransferShape, target: TransferShape) -> None:
        self._correspondence, self._source, self._target = shape_map.correspondence, source, target
        self._source_mesh, self._target_mesh = source.mesh, target.mesh
        # What spreads over the surface must not end at a seam.
        self._places = shape_map.place_of_vertex
        self._welded = compute.TriangleMesh(target.arrays.vertices, self._places[target.arrays.triangles])
        self.torn_seams: list[str] = []

    def doubts_by_place(self) -> list[str]:
        """Return sentences about what does not lie on the source; none if it was matched by shape."""
        if self._correspondence.matching is not None:
            return []
        names = self._target.name, self._source.name
        is_sure = self._correspondence.is_sure[self._welded.triangles].any(axis=1)
        n_far = int((np.bincount(self._welded.component_of_triangle, is_sure) == 0).sum())
        unsure = 1 - self._correspondence.overlap
        doubts = [NOT_ALL_THERE.format(unsure, *names)] if unsure > MUCH_UNSURE else []
        return [*doubts, FAR.format(*names, n_far)] if n_far else doubts

    def filled(self, layer: Layer) -> Layer:
        """Return a mapped layer with what fits smoothly in place of what is unsure."""
        if not layer.can_blend or layer.kind == layers.CORNER:
            return layer
        return layer.with_values(self._filled_values(layer.values.astype(np.float64)))

    def _filled_values(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        return compute.fill_unsure(self._correspondence, self._welded, values)[self._places]

    def filled_together(self, filled: list[Layer], mapped: list[Layer]) -> list[Layer]:
        """Return filled layers whose weights sum to what filling their sums gives: by place each goes its own way."""
        if self._correspondence.matching is not None or not any(layer.kind == layers.GROUP for layer in filled):
            return filled
        sums, wanted = _sum_of_groups(filled), self._filled_values(_sum_of_groups(mapped))
        share = np.where(sums > 0, wanted / np.where(sums > 0, sums, 1), 1)
        return [layer.with_values(layer.values * share) if layer.kind == layers.GROUP else layer for layer in filled]

    def map(self, layer: Layer) -> Layer:
        """Return the layer with values for the target."""
        if layer.kind in (layers.GROUP, layers.POINT):
            correspondence = self._correspondence
            transfer = correspondence.transfer if layer.can_blend else correspondence.transfer_labels
            return layer.with_values(transfer(layer.values))
        if layer.kind == layers.SHAPE_KEY:
            return layer.with_values(self._displacements(layer.values))
        if layer.kind == layers.CORNER:
            return layer.with_values(self._corners(layer))
        return layer.with_values(self.faces(layer.values))

    def _displacements(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the displacements of vertices; they are turned and scaled from shape to shape."""
        moved = self._source.arrays.stretch.of(values)
        if self._correspondence.matching is None:
            # Both stand in the world.
            moved = moved @ self._source.to_world[:3, :3].T
        moved = compute.transfer_displacements(self._correspondence, self._source_mesh, self._welded, moved)
        if self._correspondence.matching is None:
            moved = moved @ np.linalg.inv(self._target.to_world[:3, :3]).T
        return self._target.arrays.stretch.inverse.of(moved[self._places])

    def faces(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return for each face what most of its area has on the source."""
        kinds, kind = np.unique(values, axis=0, return_inverse=True)
        labels = self._correspondence.transfer_faces(kind.reshape(-1)[self._source.arrays.polygon_of_triangle])
        n_polygons = int(self._target.corner_polygon.max(initial=-1)) + 1
        polygon = self._target.arrays.polygon_of_triangle
        return kinds[compute.majority_of_polygons(labels, self._target_mesh.areas, polygon, n_polygons)]

    def _corners(self, layer: Layer) -> NDArray[np.float64]:
        triangle_of_polygon = np.zeros(int(self._target.corner_polygon.max(initial=-1)) + 1, dtype=np.int64)
        polygon = self._target.arrays.polygon_of_triangle
        triangle_of_polygon[polygon[::-1]] = np.arange(len(polygon))[::-1]
        values, keeps_seams = compute.transfer_corners(
            self._correspondence,
            self._source_mesh,
            layer.values.astype(np.float64)[self._source.corners],
            self._target.corner_vertex,
            triangle_of_polygon[self._target.corner_polygon],
        )
        if not keeps_seams:
            self.torn_seams.append(layer.name)
        return values


def _sum_of_groups(given: list[Layer]) -> NDArray[np.float64]:
    return np.sum([layer.values for layer in given if layer.kind == layers.GROUP], axis=0, dtype=np.float64)
