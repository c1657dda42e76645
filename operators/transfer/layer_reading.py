"""Read from an object the layers that are to be transferred."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks import layers
from ...tasks.attribute_types import STORAGES
from ...tasks.layers import Layer
from ...tasks.refusals import Refusal
from ..blender.known_values import data_of, mesh_of
from ..mesh_data import mesh_arrays
from ..mesh_data.attribute_values import kind_of, read_attribute
from ..mesh_state.schema import ATTRIBUTES
from ..outputs import material_slots
from ..outputs.division import PART
from ..outputs.part_writer import read_labels
from . import layer_choices
from .drivers import rigs_of
from .shape_keys import flipped_settings, read_shape_keys

# Attributes that begin with a point are Blender's own, but these are made by hand.
MADE_BY_HAND = (".sculpt_face_set", ".sculpt_mask")
# These have a layer of their own, or are the shape itself.
NOT_ATTRIBUTES = ("position", "material_index")


@dataclass(frozen=True)
class LayerChoice:
    """The layers that are wanted.

    Attributes
    ----------
    kinds : frozenset of str
        Some of ``layer_choices.LAYERS``.
    groups : str
        "ALL", "DEFORM" or "NAMED".
    group_names : tuple of str
    swaps_sides : bool
        Whether what is left on the source is right on the target.
    """

    kinds: frozenset[str]
    groups: str
    group_names: tuple[str, ...]
    swaps_sides: bool


def read_layers(obj: bpy.types.Object, choice: LayerChoice) -> list[Layer]:
    """Return the chosen layers of an object, under the names that they get on the targets."""
    readers = {
        layer_choices.PARTS: read_parts,
        layer_choices.GROUPS: lambda obj: _groups(obj, _chosen_groups(obj, choice)),
        layer_choices.SHAPE_KEYS: lambda obj: _shape_keys(obj, choice),
        layer_choices.MATERIALS: _materials,
    }
    given = [layer for kind, read in readers.items() if kind in choice.kinds for layer in read(obj)]
    given += [layer for kind, layer in _attributes(mesh_of(obj)) if kind in choice.kinds]
    if not given:
        raise Refusal(f"{obj.name} has none of the layers that were chosen.")
    return [_with_side(layer) for layer in given] if choice.swaps_sides else given


def _with_side(layer: Layer) -> Layer:
    if layer.kind not in (layers.GROUP, layers.SHAPE_KEY):
        return layer
    settings = layer.settings and flipped_settings(layer.settings)
    return replace(layer, name=bpy.utils.flip_name(layer.name), settings=settings)


def read_parts(obj: bpy.types.Object) -> list[Layer]:
    """Return the parts of an object as a layer; none if it has none."""
    mesh = mesh_of(obj)
    if PART.name in mesh_arrays.own_names(mesh) and PART.name in mesh.attributes:
        return [Layer(layers.PARTS, PART.name, read_labels(mesh).reshape(-1, 1), "INT")]
    return []


def _chosen_groups(obj: bpy.types.Object, choice: LayerChoice) -> list[str]:
    known = [group.name for group in obj.vertex_groups]
    if choice.groups == "NAMED":
        missing = [name for name in choice.group_names if name not in known]
        if missing:
            raise Refusal(f'{obj.name} has no vertex group "{missing[0]}".')
        return list(choice.group_names)
    if choice.groups == "DEFORM":
        bones = _deform_bones(obj)
        if not bones:
            raise Refusal(f"{obj.name} has no armature whose bones deform it; transfer all groups or name some.")
        return [name for name in known if name in bones]
    return known


def _deform_bones(obj: bpy.types.Object) -> set[str]:
    return {bone.name for rig in rigs_of(obj) for bone in data_of(rig, bpy.types.Armature).bones if bone.use_deform}


def _groups(obj: bpy.types.Object, names: list[str]) -> Iterator[Layer]:
    weights = read_weights(obj, names)
    for name, column in zip(names, weights.T, strict=True):
        yield Layer(layers.GROUP, name, column.reshape(-1, 1))


def read_weights(obj: bpy.types.Object, names: list[str]) -> NDArray[np.float64]:
    """Return (V, n) the weights of vertex groups, 0 where there is no such group or the vertex is not in it."""
    weights = np.zeros((len(mesh_of(obj).vertices), len(names)))
    column = {obj.vertex_groups[name].index: place for place, name in enumerate(names) if name in obj.vertex_groups}
    # Blender gives weights away one vertex at a time only.
    for vertex in mesh_of(obj).vertices if column else ():
        for element in vertex.groups:
            if element.group in column:
                weights[vertex.index, column[element.group]] = element.weight
    return weights


def _shape_keys(obj: bpy.types.Object, choice: LayerChoice) -> Iterator[Layer]:
    """Yield the shape keys, and the vertex groups that limit them, which the targets may lack."""
    given = list(read_shape_keys(obj))
    chosen = _chosen_groups(obj, choice) if layer_choices.GROUPS in choice.kinds else ()
    limits = dict.fromkeys(layer.settings.vertex_group for layer in given if layer.settings)
    names = [name for name in limits if name in obj.vertex_groups and name not in chosen]
    yield from (replace(layer, is_companion=True) for layer in _groups(obj, names))
    yield from given


def _materials(obj: bpy.types.Object) -> Iterator[Layer]:
    mesh = mesh_of(obj)
    names, indices = material_slots.assignment_of_user(mesh)
    if not names:
        return
    yield Layer(layers.MATERIAL, "materials", np.clip(indices, 0, len(names) - 1).reshape(-1, 1), "INT", names)


def _attributes(mesh: bpy.types.Mesh) -> Iterator[tuple[str, Layer]]:
    """Yield the attributes that are not ours, each with the kind of layer that it belongs to."""
    ours = {*mesh_arrays.own_names(mesh), *(own.name for own in ATTRIBUTES)}
    for attribute in mesh.attributes:
        kind = _kind_of(attribute)
        is_blenders = attribute.name.startswith(".") and attribute.name not in MADE_BY_HAND
        if kind and not is_blenders and attribute.name not in ours and attribute.name not in NOT_ATTRIBUTES:
            data_type, domain = kind_of(attribute)
            is_uv = kind == layer_choices.UVS
            yield kind, Layer(domain, attribute.name, read_attribute(attribute), data_type, is_uv=is_uv)


def _kind_of(attribute: bpy.types.Attribute) -> str:
    """Return the kind of layer that an attribute is, or nothing if it cannot be transferred."""
    if attribute.data_type not in STORAGES:
        return ""
    if attribute.data_type in ("FLOAT_COLOR", "BYTE_COLOR") and attribute.domain in ("POINT", "CORNER"):
        return layer_choices.COLORS
    if attribute.domain == "CORNER":
        return layer_choices.UVS if attribute.data_type == "FLOAT2" else ""
    return {"POINT": layer_choices.ATTRIBUTES, "FACE": layer_choices.FACES}.get(attribute.domain, "")
