"""The values of attributes of all kinds as arrays, however Blender keeps them."""

from typing import cast

import bpy
import numpy as np

from ...tasks.attribute_types import STORAGES, AttributeType, Domain, Values
from ..blender.known_values import elements_of


def kind_of(attribute: bpy.types.Attribute) -> tuple[AttributeType, Domain]:
    """Return the type and the domain of an attribute whose values can be stored; the stubs know more of both."""
    return cast(AttributeType, attribute.data_type), cast(Domain, attribute.domain)


def read_attribute(attribute: bpy.types.Attribute) -> Values:
    """Return the (n, components) values of an attribute."""
    storage = STORAGES[attribute.data_type]
    elements = elements_of(attribute)
    values: Values = np.empty(len(elements) * storage.n_components, dtype=storage.dtype)
    elements.foreach_get(storage.property_name, values)
    return values.reshape(-1, storage.n_components)


def store_values(attribute: bpy.types.Attribute, values: Values) -> None:
    """Write the (n, components) values of an attribute."""
    storage = STORAGES[attribute.data_type]
    flat = np.ascontiguousarray(values, dtype=storage.dtype).ravel()
    elements_of(attribute).foreach_set(storage.property_name, flat)
