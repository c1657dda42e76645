"""Transfer layers between meshes; knows nothing of Blender, so any thread may do it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ... import compute
from ..jobs import recent_analyses
from ..jobs.recent_results import Recent, key_of
from ..mesh_data.mesh_arrays import MeshArrays
from ..messages.user_errors import Refusal, in_name_of
from . import layers
from .layers import Layer

Progress = Callable[[float, str], None]

# What an analysis needs for matching.
JUST_ENOUGH = {"n_functions": 2, "order": 1}
# Vertices of all maps that are kept; each takes a tenth of a kB.
RECENT_VERTICES = 200_000
# A matching this unsure is none.
NO_MATCH = 0.03
NOT_ALIKE = (
    "{} and {} are not alike enough to be matched (confidence {:.0%}); nothing was transferred. If one is the mirror"
    " image of the other, choose Mirrored."
)

_recent_maps = Recent(RECENT_VERTICES)


@dataclass(frozen=True, eq=False)
class Body:
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
    flips : mapping of int to +1 or -1
        Signs that the user gave when the mesh was registered to the source.
    alternative : int
        Which matching the user chose then.
    """

    name: str
    arrays: MeshArrays
    corners: np.ndarray
    corner_vertex: np.ndarray
    corner_polygon: np.ndarray
    flips: Mapping[int, int] = field(default_factory=dict)
    alternative: int = 0


@dataclass(frozen=True, eq=False)
class Transferred:
    """What one target gets.

    Attributes
    ----------
    layers : list of Layer
    is_sure : (V,) bool
    found_by : str
        "number", "faces" or "shape".
    confidence : float
        Of the matching.
    torn_seams : tuple of str
        Layers whose seams could not be kept.
    """

    layers: list[Layer]
    is_sure: np.ndarray
    found_by: str
    confidence: float
    torn_seams: tuple[str, ...]


def transfer_bodies(
    source: Body, given: list[Layer], targets: list[Body], *, mirrored: bool, fills: bool, progress: Progress
) -> list[Transferred]:
    """Return what each target gets.

    Parameters
    ----------
    mirrored : bool
        Whether the targets are mirror images.
    fills : bool
        Whether unsure vertices are filled in from their neighbours.
    """
    targets = [_split_alike(source, target) for target in targets]
    found = _correspondences(source, targets, mirrored, progress)
    here = _mesh_of(source)
    return [
        _transferred(one, here, _mesh_of(target), (source, target), given, fills)
        for one, target in zip(found, targets, strict=True)
    ]


def _mesh_of(body: Body) -> compute.TriangleMesh:
    return compute.TriangleMesh(body.arrays.vertices, body.arrays.triangles)


def _correspondences(
    source: Body, targets: list[Body], mirrored: bool, progress: Progress
) -> list[compute.Correspondence]:
    """Return the maps to all targets; those that were found for other layers before are at hand."""
    keys = [_key_of_map(source, target, mirrored) for target in targets]
    found = {key: _recent_maps.get(key) for key in keys}
    missing = {key: target for key, target in zip(keys, targets, strict=True) if found[key] is None}
    if missing:
        found |= _new_correspondences(source, missing, mirrored, progress)
    return [found[key] for key in keys]


def _new_correspondences(
    source: Body, targets: Mapping[str, Body], mirrored: bool, progress: Progress
) -> dict[str, compute.Correspondence]:
    # All are analyzed first: what cannot be is told before the longer part begins.
    first, *others = _steps(compute.section(progress, 0, 0.3), 1 + len(targets))
    here = _analyze(source, first, recent_analyses.recall)
    bodies = zip(targets.values(), others, strict=True)
    analyses = [_analyze(target, told, recent_analyses.reuse) for target, told in bodies]
    found = {}
    steps = _steps(compute.section(progress, 0.3, 0.95), len(targets))
    for (key, target), there, step in zip(targets.items(), analyses, steps, strict=True):
        found[key] = _correspond(source, target, here, there, mirrored, compute.naming(step, target.name))
        _recent_maps.put(key, found[key], len(target.arrays.vertices))
    return found


def _key_of_map(source: Body, target: Body, mirrored: bool) -> str:
    places = [array for body in (source, target) for array in (body.arrays.vertices, body.arrays.triangles)]
    return key_of([*places, mirrored, sorted(target.flips.items()), target.alternative])


def _steps(progress: Progress, number: int) -> list[Progress]:
    """Return callbacks whose 0..1 are equal steps, one after the other."""
    return [compute.section(progress, k / number, (k + 1) / number) for k in range(number)]


def _split_alike(source: Body, target: Body) -> Body:
    """Return a target with the triangles of the source where the faces are the same: poses may split quads apart."""
    alike = (
        len(source.arrays.vertices) == len(target.arrays.vertices)
        and np.array_equal(source.corner_vertex, target.corner_vertex)
        and np.array_equal(source.corner_polygon, target.corner_polygon)
    )
    if not alike:
        return target
    triangles = target.corner_vertex[source.corners]
    polygons = source.arrays.polygon_of_triangle
    return replace(target, arrays=replace(target.arrays, triangles=triangles, polygon_of_triangle=polygons))


def _analyze(
    body: Body, progress: Progress, analysis_of: Callable[[MeshArrays, dict[str, Any], Progress], compute.Analysis]
) -> compute.Analysis:
    """Return an analysis that is just enough for matching."""
    with in_name_of(body.name):
        return analysis_of(body.arrays, JUST_ENOUGH, compute.naming(progress, body.name))


def _correspond(
    source: Body, target: Body, here: Any, there: Any, mirrored: bool, progress: Progress
) -> compute.Correspondence:
    flips = dict(target.flips)
    matching = compute.match(here, there, flips=flips, mirrored=mirrored, progress=compute.section(progress, 0, 0.5))
    choices = (matching, *matching.alternatives)
    matching = choices[target.alternative % len(choices)]
    if matching.confidence < NO_MATCH:
        raise Refusal(NOT_ALIKE.format(source.name, target.name, matching.confidence))
    return compute.correspond(here, there, matching=matching, progress=compute.section(progress, 0.5, 1))


def _transferred(
    found: compute.Correspondence, here: Any, there: Any, bodies: tuple[Body, Body], given: list[Layer], fills: bool
) -> Transferred:
    carrier = _Carrier(found, here, there, *bodies)
    carried = [carrier.carry(layer) for layer in given]
    if fills and not found.is_sure.all():
        carried = [_filled(found, there, layer) for layer in carried]
    return Transferred(
        carried, found.is_sure, found.found_by, float(found.matching.confidence), tuple(carrier.torn_seams)
    )


def _filled(found: compute.Correspondence, there: Any, layer: Layer) -> Layer:
    if not layer.can_blend or layer.kind == layers.CORNER:
        return layer
    return layer.with_values(compute.fill_unsure(found, there, layer.values.astype(np.float64)))


class _Carrier:
    """Carries layers from one mesh to another."""

    def __init__(self, found: compute.Correspondence, here: Any, there: Any, source: Body, target: Body) -> None:
        self._found, self._here, self._there = found, here, there
        self._source, self._target = source, target
        self.torn_seams: list[str] = []

    def carry(self, layer: Layer) -> Layer:
        """Return the layer with values for the target."""
        if layer.kind in (layers.GROUP, layers.POINT):
            how = self._found.transfer if layer.can_blend else self._found.transfer_labels
            return layer.with_values(how(layer.values))
        if layer.kind == layers.SHAPE_KEY:
            moved = compute.transfer_displacements(self._found, self._here, self._there, layer.values)
            return layer.with_values(moved)
        if layer.kind == layers.CORNER:
            return layer.with_values(self._corners(layer))
        return layer.with_values(self._faces(layer.values))

    def _faces(self, values: np.ndarray) -> np.ndarray:
        """Return for each face what most of its area has on the source."""
        kinds, kind = np.unique(values, axis=0, return_inverse=True)
        labels = self._found.transfer_faces(kind.reshape(-1)[self._source.arrays.polygon_of_triangle])
        n_polygons = int(self._target.corner_polygon.max(initial=-1)) + 1
        polygon = self._target.arrays.polygon_of_triangle
        return kinds[compute.majority_of_polygons(labels, self._there.areas, polygon, n_polygons)]

    def _corners(self, layer: Layer) -> np.ndarray:
        triangle_of_polygon = np.zeros(int(self._target.corner_polygon.max(initial=-1)) + 1, dtype=np.int64)
        polygon = self._target.arrays.polygon_of_triangle
        triangle_of_polygon[polygon[::-1]] = np.arange(len(polygon))[::-1]
        values, keeps_seams = compute.transfer_corners(
            self._found,
            self._here,
            layer.values.astype(np.float64)[self._source.corners],
            self._target.corner_vertex,
            triangle_of_polygon[self._target.corner_polygon],
        )
        if not keeps_seams:
            self.torn_seams.append(layer.name)
        return values
