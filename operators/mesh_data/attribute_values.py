"""The values of attributes of all kinds as arrays, however Blender keeps them."""

from dataclasses import dataclass

import bpy
import numpy as np


@dataclass(frozen=True)
class Storage:
    """How Blender keeps one kind of attribute: the property, its numbers, and whether values can be blended."""

    property_name: str
    n_components: int
    dtype: type
    can_blend: bool


STORAGES = {
    "FLOAT": Storage("value", 1, np.float32, True),
    "INT": Storage("value", 1, np.int32, False),
    "INT8": Storage("value", 1, np.int32, False),
    "BOOLEAN": Storage("value", 1, np.bool_, False),
    "FLOAT2": Storage("vector", 2, np.float32, True),
    "FLOAT_VECTOR": Storage("vector", 3, np.float32, True),
    "FLOAT_COLOR": Storage("color", 4, np.float32, True),
    "BYTE_COLOR": Storage("color", 4, np.float32, True),
}


def read_attribute(attribute: bpy.types.Attribute) -> np.ndarray:
    """Return the (n, components) values of an attribute."""
    storage = STORAGES[attribute.data_type]
    values = np.empty(len(attribute.data) * storage.n_components, dtype=storage.dtype)
    attribute.data.foreach_get(storage.property_name, values)
    return values.reshape(-1, storage.n_components)


def store_values(attribute: bpy.types.Attribute, values: np.ndarray) -> None:
    """Write the (n, components) values of an attribute."""
    storage = STORAGES[attribute.data_type]
    attribute.data.foreach_set(storage.property_name, np.ascontiguousarray(values, dtype=storage.dtype).ravel())
