"""Types of attributes: how Blender keeps their values, and whether these can be blended."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

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
