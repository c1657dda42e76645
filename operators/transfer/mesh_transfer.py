"""Use case: layers of one mesh given to others, the same from the window, from scripts and on the command line.

``read_source`` and ``read_target`` take what is needed from objects, `layer_mapping` computes on values alone, and
``write_all`` puts the layers on the objects and returns what is to be told.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.layer_mapping import MappedLayers, ShapeParts, TransferShape
from ...tasks.layers import PARTS, Layer
from ...tasks.match_options import NO_POINTS, GivenPoints, MatchOptions
from ...tasks.mesh_shape import MeshArrays
from ...tasks.refusals import Refusal, in_name_of
from ..blender.known_values import mesh_of
from ..mesh_data import mesh_arrays
from ..mesh_data.unfinished_meshes import modifiers_that_add, unfinished
from ..mesh_data.world_shape import as_transform, world_matrix
from ..mesh_state.registration_record import SURE, remembered_options
from ..mesh_state.state import is_analyzed, read
from ..messages.sentences import Messages
from ..messages.user_errors import refuse_unwritable
from .layer_reading import LayerChoice, read_layers, read_parts
from .layer_rollback import layers_or_nothing
from .layer_writing import WHOLE, Mix, refuse_obstacles, write_layers

HAS_PARTS = "{} was analyzed and keeps its own parts; Register Selected gives it those of {}."
FOUND_BY = {
    "number": "Vertices correspond by their numbers.",
    "faces": "The faces are the same under other numbers.",
    "place": "The mesh lies on the other one, so nearest points were taken.",
    "shape": "Matched by shape.",
}


@dataclass(frozen=True)
class TransferSettings:
    """Layers of a transfer and how they are written.

    Attributes
    ----------
    choice : LayerChoice
    mix : Mix
    fills_unsure : bool
        Whether unsure vertices are filled in from their neighbours.
    use_modifiers : bool
        Whether shapes are matched as modifiers leave them.
    method : str
        How vertices are found to correspond: "auto", "place" or "shape".
    """

    choice: LayerChoice
    mix: Mix = WHOLE
    fills_unsure: bool = True
    use_modifiers: bool = False
    method: str = "auto"


@dataclass(frozen=True, eq=False)
class TransferSource:
    """The object whose layers all others get.

    Attributes
    ----------
    shape : TransferShape
    layers : list of Layer
    colours : (n, 4) float32
        Of its parts, by their labels.
    """

    shape: TransferShape
    layers: list[Layer]
    colours: NDArray[np.float32]

    @property
    def name(self) -> str:
        """Name of the object."""
        return self.shape.name


def read_source(context: bpy.types.Context, obj: bpy.types.Object, settings: TransferSettings) -> TransferSource:
    """Return the layers of an object that were chosen, and its shape, or say why there can be none."""
    shape = _read_shape(context, obj, MatchOptions(), settings)
    if not settings.choice.kinds:
        raise Refusal("Choose at least one layer to transfer.")
    layers = read_layers(obj, settings.choice)
    highest = max((int(layer.values.max(initial=0)) for layer in layers if layer.kind == PARTS), default=0)
    return TransferSource(shape, layers, read(mesh_of(obj)).parts.colours_of(highest + 1))


def read_target(
    context: bpy.types.Context,
    obj: bpy.types.Object,
    source: TransferSource,
    settings: TransferSettings,
    points: GivenPoints = NO_POINTS,
) -> TransferShape:
    """Return the shape of an object that the layers of a source can be written to, or say why they cannot."""
    match = read(mesh_of(obj)).match
    # What the user chose of the matchings with this source holds for the transfer as well.
    known = remembered_options(match) if match is not None and match.reference == source.name else MatchOptions()
    options = replace(known, mirrored=settings.choice.swaps_sides, points=points)
    shape = _read_shape(context, obj, options, settings)
    refuse_obstacles(obj, source.layers, settings.mix)
    return shape


def write_all(
    objects: Sequence[bpy.types.Object],
    mapped: Sequence[MappedLayers],
    source: TransferSource,
    settings: TransferSettings,
) -> list[Messages]:
    """Write layers to all objects or to none, and return what is to be told of each."""
    for obj, one in zip(objects, mapped, strict=True):
        refuse_obstacles(obj, one.layers, settings.mix)
    told = []
    with ExitStack() as all_of_them:
        for obj, one in zip(objects, mapped, strict=True):
            all_of_them.enter_context(layers_or_nothing(obj, one.layers))
            told.append(write_layers(obj, one.layers, settings.mix, source.colours))
    return [
        _messages(obj, source.name, one, settings, sentences)
        for obj, one, sentences in zip(objects, mapped, told, strict=True)
    ]


def _read_shape(
    context: bpy.types.Context, obj: bpy.types.Object, options: MatchOptions, settings: TransferSettings
) -> TransferShape:
    with in_name_of(obj.name):
        refuse_unwritable(mesh_of(obj))
        arrays = mesh_arrays.read_object(context, obj, settings.use_modifiers)
    return _shape_of(obj, arrays, options)


def _shape_of(obj: bpy.types.Object, arrays: MeshArrays, options: MatchOptions) -> TransferShape:
    """Return an object in the form that layers are transferred in."""
    mesh = mesh_of(obj)
    corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    n_corners = mesh_arrays.n_corners_of_polygon(mesh)
    return TransferShape(
        name=obj.name,
        arrays=arrays,
        corners=arrays.stretch.turned(corners.reshape(-1, 3).astype(np.int64)),
        corner_vertex=mesh_arrays.vertex_of_corner(mesh).astype(np.int64),
        corner_polygon=np.repeat(np.arange(len(n_corners)), n_corners),
        to_world=np.array(world_matrix(obj) @ as_transform(arrays.stretch.inverse), dtype=np.float64),
        options=options,
        unfinished=unfinished(obj.name, modifiers_that_add(obj)),
        parts=_parts_of(obj),
    )


def _parts_of(obj: bpy.types.Object) -> ShapeParts | None:
    """Return the parts that an object shows; None if it has none, or none that can be read: they only name places."""
    try:
        shown = [parts.values[:, 0] for parts in read_parts(obj)]
        table = read(mesh_of(obj)).parts
    except Refusal:
        return None
    return ShapeParts(shown[0], {part: table.name_of(part) for part in np.unique(shown[0]).tolist()}) if shown else None


def _messages(
    obj: bpy.types.Object, source: str, mapped: MappedLayers, settings: TransferSettings, told: list[str]
) -> Messages:
    n_layers = len(mapped.layers)
    given = f"{obj.name}: {n_layers} layers of {source}." if n_layers > 1 else f"{obj.name}: 1 layer of {source}."
    infos = (given, FOUND_BY[mapped.found_by], _unsure(mapped, settings))
    return Messages(infos, (*mapped.warnings, *_doubts(obj, source, mapped), *told))


def _doubts(obj: bpy.types.Object, source: str, mapped: MappedLayers) -> list[str]:
    doubts = [f"{obj.name}: {part}: {share:.0%} unsure." for part, share in mapped.unsure_parts.items()]
    doubts += [
        f'{obj.name}: the seams of "{name}" could not be kept, there are too many pieces.' for name in mapped.torn_seams
    ]
    if mapped.confidence <= SURE and mapped.found_by != "place":
        doubts.insert(0, f"{obj.name} is matched with a confidence of {mapped.confidence:.0%} only.")
    if mapped.confidence <= SURE:
        doubts += mapped.unfinished
    if is_analyzed(mesh_of(obj)) and any(layer.kind == PARTS for layer in mapped.layers):
        doubts.append(HAS_PARTS.format(obj.name, source))
    return doubts


def _unsure(mapped: MappedLayers, settings: TransferSettings) -> str:
    """Return how many vertices are unsure; empty if all are sure."""
    n_unsure, n_vertices = int((~mapped.is_sure).sum()), len(mapped.is_sure)
    if n_unsure and settings.fills_unsure:
        return f"{n_unsure} of {n_vertices} vertices are unsure and were filled in."
    return f"{n_unsure} of {n_vertices} vertices are unsure." if n_unsure else ""
