"""Shape keys with all that they are set to: read from an object, and written to another."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks import layers
from ...tasks.layers import Layer
from ...tasks.refusals import Refusal
from ...tasks.shape_key_settings import ShapeKeySettings
from ..blender.known_values import mesh_of, present
from .drivers import flipped_driver, read_drivers, write_drivers
from .rna_settings import read_settings, write_settings

ABSOLUTE = "The shape keys of {} are absolute; only relative ones can be transferred."
STRANGE = '{}: nothing here takes the place of "{}", which the driver of the shape key "{}" reads.'
# Not carried: what a key is called is the layer's name, and a lock would stand in the way of the next transfer.
NOT_CARRIED = ("name", "lock_shape", "select")
# The least that a slider can go down to.
LOWEST = -10.0


def read_shape_keys(obj: bpy.types.Object) -> Iterator[Layer]:
    """Yield the shape keys of an object but for the Basis, those that others start from before these."""
    keys = mesh_of(obj).shape_keys
    if keys is None:
        return
    if not keys.use_relative:
        raise Refusal(ABSOLUTE.format(obj.name))
    for block in sorted(keys.key_blocks[1:], key=lambda block: _depth(block, len(keys.key_blocks))):
        moved = read_key(block) - read_key(block.relative_key)
        yield Layer(layers.SHAPE_KEY, block.name, moved, settings=_read_settings(obj, block))


def flipped_settings(settings: ShapeKeySettings) -> ShapeKeySettings:
    """Return the settings of the mirrored key."""
    group, start = (name and bpy.utils.flip_name(name) for name in (settings.vertex_group, settings.relative_to))
    drivers = tuple(flipped_driver(driver) for driver in settings.drivers)
    return replace(settings, values=settings.values | {"vertex_group": group}, relative_to=start, drivers=drivers)


def read_key(block: bpy.types.ShapeKey) -> NDArray[np.float64]:
    """Return the (V, 3) positions of a shape key."""
    positions = np.empty(3 * len(block.data), dtype=np.float32)
    block.data.foreach_get("co", positions)
    return positions.reshape(-1, 3).astype(np.float64)


def write_shape_keys(obj: bpy.types.Object, some: list[Layer], share: NDArray[np.float64]) -> list[str]:
    """Write shape keys, and return what is to be told; keys that were there before stay set as they are."""
    keys = mesh_of(obj).shape_keys
    known = set(keys.key_blocks.keys()) if keys else set()
    for layer in some:
        _write_places(obj, layer, share)
    new = [layer for layer in some if layer.name not in known]
    # What drivers read of other keys is there by now.
    return [sentence for layer in new for sentence in _write_drivers(obj, layer)]


def _depth(block: bpy.types.ShapeKey, most: int) -> int:
    """Return how many keys lie between a key and one that starts from itself, as the Basis does."""
    depth = 0
    while block.relative_key != block and depth < most:
        block, depth = block.relative_key, depth + 1
    return depth


def _read_settings(obj: bpy.types.Object, block: bpy.types.ShapeKey) -> ShapeKeySettings:
    is_basis = block.relative_key == present(mesh_of(obj).shape_keys).reference_key
    start = "" if is_basis else block.relative_key.name
    return ShapeKeySettings(read_settings(block, NOT_CARRIED), start, read_drivers(obj, block))


def _write_places(obj: bpy.types.Object, layer: Layer, share: NDArray[np.float64]) -> None:
    block = present(mesh_of(obj).shape_keys).key_blocks.get(layer.name) or _new_key(obj, layer)
    start = read_key(block.relative_key)
    moved = start + compute.mixed(read_key(block) - start, layer.values, share)
    block.data.foreach_set("co", moved.astype(np.float32).ravel())


def _new_key(obj: bpy.types.Object, layer: Layer) -> bpy.types.ShapeKey:
    """Add a key that moves nothing yet, set as the one that it comes from."""
    keys, settings = present(mesh_of(obj).shape_keys), present(layer.settings)
    block = obj.shape_key_add(name=layer.name, from_mix=False)
    block.relative_key = keys.key_blocks.get(settings.relative_to) or keys.reference_key
    block.data.foreach_set("co", read_key(block.relative_key).astype(np.float32).ravel())
    # A slider never ends below where it begins, also while it is set.
    block.slider_min = LOWEST
    write_settings(block, {"slider_max": settings.values["slider_max"], **settings.values})
    return block


def _write_drivers(obj: bpy.types.Object, layer: Layer) -> Iterator[str]:
    strange = write_drivers(obj, layer.name, present(layer.settings).drivers)
    yield from (STRANGE.format(obj.name, name, layer.name) for name in sorted(strange))
