"""Arrays and records as what custom properties can hold: plain numbers and texts."""

from dataclasses import fields
from typing import Any

import numpy as np

_INT32 = np.iinfo(np.int32)
_DTYPES = ("int64", "float64", "bool")


def packed(record: Any, rows: slice = slice(None)) -> dict[str, Any]:
    """Return numbers of a record, and arrays as lists with their shapes; what belongs to each face is an attribute."""
    values = {field.name: getattr(record, field.name) for field in fields(record) if field.name != "of_face"}
    arrays = {name: packed_array(value[rows]) for name, value in values.items() if isinstance(value, np.ndarray)}
    return arrays | {name: value for name, value in values.items() if isinstance(value, bool | int | float)}


def packed_array(array: np.ndarray) -> dict[str, Any]:
    """Return an array as a list with its shape."""
    values = array
    if array.dtype.kind in "iub":
        # Custom properties hold 32 bits; beyond that there is only the "never" of a tree's root, and it stays so.
        values = np.clip(array, _INT32.min, _INT32.max)
    dtype = {"i": "int64", "u": "int64", "f": "float64", "b": "bool"}[array.dtype.kind]
    return {"dtype": dtype, "shape": list(array.shape)} | ({"values": values.ravel().tolist()} if array.size else {})


def unpacked(group: Any) -> dict[str, Any]:
    """Return the fields of a packed record."""
    return {name: unpacked_array(group[name]) if hasattr(group[name], "keys") else group[name] for name in group}


def unpacked_array(group: Any) -> np.ndarray:
    """Return the array; raises ValueError, TypeError or KeyError if there is none."""
    if group["dtype"] not in _DTYPES:
        raise ValueError(group["dtype"])
    values = np.array(group.get("values", []), dtype=group["dtype"])
    return values.reshape([int(size) for size in group["shape"]])
