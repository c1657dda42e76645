"""The values of attributes of all kinds as arrays, however Blender keeps them."""

from dataclasses import dataclass
from typing import Any, Literal, cast

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender.known_values import elements_of

AttributeType = Literal["FLOAT", "INT", "INT8", "BOOLEAN", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR"]
Domain = Literal["POINT", "EDGE", "FACE", "CORNER"]
# Of any of the types below.
Values = NDArray[Any]


@dataclass(frozen=True)
class Storage:
    """The form of one kind of attribute in Blender: the property, its numbers, and whether values can be blended."""

    property_name: str
    n_components: int
    dtype: type[np.float32] | type[np.int32] | type[np.bool_]
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
