"""Arrays and records as what custom properties can hold: plain numbers and texts.

A file may come from anywhere, so only what has the type that was written is read back, and nothing larger than it is.
"""

import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_args, get_origin

import numpy as np
from numpy.typing import NDArray

# What reading something else than was written may raise.
UNREADABLE = (AttributeError, IndexError, KeyError, OverflowError, TypeError, ValueError)
_INT32 = np.iinfo(np.int32)
# How Blender keeps the numbers of each type; lists of anything else are no arrays of ours.
_TYPECODES = {"int64": "i", "float64": "dfi", "bool": "bi"}


def packed(record: Any, rows: slice = slice(None)) -> dict[str, Any]:
    """Return numbers of a record, and arrays as lists with their shapes; what belongs to each face is an attribute."""
    values = {field.name: getattr(record, field.name) for field in fields(record) if field.name != "of_face"}
    arrays = {name: packed_array(value[rows]) for name, value in values.items() if isinstance(value, np.ndarray)}
    return arrays | {name: value for name, value in values.items() if isinstance(value, bool | int | float)}


def packed_array(array: NDArray[Any]) -> dict[str, Any]:
    """Return an array as a list with its shape."""
    values = array
    if array.dtype.kind in "iub":
        # Custom properties hold 32 bits; beyond that there is only the "never" of a tree's root, and it stays so.
        values = np.clip(array, _INT32.min, _INT32.max)
    dtype = {"i": "int64", "u": "int64", "f": "float64", "b": "bool"}[array.dtype.kind]
    return {"dtype": dtype, "shape": list(array.shape)} | ({"values": values.ravel().tolist()} if array.size else {})


def unpacked(group: Any, record: type, known: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the fields of a packed record; raises one of ``UNREADABLE`` if one is not what it holds.

    What belongs to each face and what is a record of its own is left out. Fields that are ``known`` are not read.
    """
    known = known or {}
    held = {field.name: field.type for field in fields(record) if field.name not in ("of_face", *known)}
    scalars = {name: _number(group[name], kind) for name, kind in held.items() if kind in (bool, int, float)}
    dtypes = {name: _dtype(kind) for name, kind in held.items() if name not in scalars and _dtype(kind)}
    arrays = {name: unpacked_array(group[name], dtype) for name, dtype in dtypes.items()}
    if not all(np.isfinite(array).all() for array in arrays.values()):
        raise ValueError("not finite")
    return {**scalars, **arrays, **known}


def unpacked_array(group: Any, dtype: str) -> NDArray[Any]:
    """Return the array; raises one of ``UNREADABLE`` if there is none of this type."""
    values, shape = group.get("values"), group["shape"]
    if group["dtype"] != dtype or getattr(shape, "typecode", None) != "i":
        raise ValueError(group["dtype"])
    if values is not None and getattr(values, "typecode", "none") not in _TYPECODES[dtype]:
        raise ValueError(type(values).__name__)
    return np.array([] if values is None else values, dtype=dtype).reshape(list(shape))


def _number(value: Any, kind: type) -> Any:
    if not isinstance(value, int if kind in (bool, int) else int | float) or not math.isfinite(value):
        raise TypeError(type(value).__name__)
    return kind(value)


def _dtype(annotation: Any) -> str:
    """Return the name of the type of an array's numbers, nothing if it is no array."""
    # From NumPy 2.5 on, NDArray is an alias of its own that keeps the numbers' type alone.
    if get_origin(annotation) not in (np.ndarray, NDArray):
        return ""
    (*_, numbers) = get_args(annotation)
    return np.dtype(get_args(numbers)[0] if get_origin(numbers) is np.dtype else numbers).name
