"""Give an object back the layers that it had if transferring to it fails half way."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import bpy

from ...tasks import layers
from ...tasks.layers import Layer
from ..blender.known_values import mesh_of, present
from ..mesh_data.attribute_values import read_attribute, store_values
from ..outputs.rollback import all_or_nothing
from .drivers import remove_drivers
from .layer_reading import read_weights
from .layer_writing import fill_group
from .shape_keys import read_key


@contextmanager
def layers_or_nothing(obj: bpy.types.Object, given: list[Layer]) -> Iterator[None]:
    """Write some layers to an object, or nothing of them if the block raises anything."""
    keepers = {layers.GROUP: _group, layers.SHAPE_KEY: _shape_key}
    kept = [
        keepers.get(layer.kind, _attribute)(obj, layer.name)
        for layer in given
        # Slots of materials and the face map are kept with what is ours.
        if layer.kind not in (layers.MATERIAL, layers.PARTS)
    ]
    places = (
        (obj.vertex_groups, "active_index"),
        (mesh_of(obj).uv_layers, "active_index"),
        (obj, "active_shape_key_index"),
    )
    active = [(owner, name, getattr(owner, name)) for owner, name in places]
    with all_or_nothing(mesh_of(obj)):
        try:
            yield
        except BaseException:
            for give_back in kept:
                give_back()
            for owner, name, index in active:
                # Where there is nothing that could be active, an index cannot be set.
                if getattr(owner, name) != index:
                    setattr(owner, name, index)
            raise


def _group(obj: bpy.types.Object, name: str) -> Callable[[], None]:
    is_new, weights = name not in obj.vertex_groups, read_weights(obj, [name])[:, 0]

    def give_back() -> None:
        if name not in obj.vertex_groups:
            return
        if is_new:
            obj.vertex_groups.remove(obj.vertex_groups[name])
        else:
            fill_group(obj.vertex_groups[name], weights, read_weights(obj, [name])[:, 0])

    return give_back


def _shape_key(obj: bpy.types.Object, name: str) -> Callable[[], None]:
    block = present(mesh_of(obj).shape_keys).key_blocks.get(name)
    places = None if block is None else read_key(block)

    def give_back() -> None:
        block = present(mesh_of(obj).shape_keys).key_blocks.get(name)
        if block is None:
            return
        if places is None:
            # Some versions of Blender leave them behind.
            remove_drivers(block)
            obj.shape_key_remove(block)
        else:
            block.data.foreach_set("co", places.ravel())

    return give_back


def _attribute(obj: bpy.types.Object, name: str) -> Callable[[], None]:
    attributes = mesh_of(obj).attributes
    values = read_attribute(attributes[name]) if name in attributes else None

    def give_back() -> None:
        if name not in attributes:
            return
        if values is None:
            attributes.remove(attributes[name])
        else:
            store_values(attributes[name], values)

    return give_back
