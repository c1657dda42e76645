"""Results computed last, kept while Blender runs: trying another matching then needs no new analysis.

Nothing depends on it: what is not here any more is computed again.
"""

import hashlib
from collections import OrderedDict
from collections.abc import Iterable
from typing import Generic, TypeVar

import numpy as np

Value = TypeVar("Value")


class Recent(Generic[Value]):
    """Values by key, the latest ones up to a total size."""

    def __init__(self, largest_size: int) -> None:
        self._largest_size = largest_size
        self._kept: OrderedDict[str, tuple[Value, int]] = OrderedDict()

    def get(self, key: str) -> Value | None:
        """Return a value, None if it is not here any more."""
        if key not in self._kept:
            return None
        self._kept.move_to_end(key)
        return self._kept[key][0]

    def put(self, key: str, value: Value, size: int) -> None:
        """Keep a value in place of the oldest ones."""
        self._kept[key] = value, size
        self._kept.move_to_end(key)
        while sum(size for _, size in self._kept.values()) > self._largest_size:
            self._kept.popitem(last=False)


def key_of(values: Iterable[object]) -> str:
    """Return a key for arrays, numbers and texts: equal for equal ones."""
    digest = hashlib.blake2b(digest_size=16)
    for value in values:
        shown = value.shape if isinstance(value, np.ndarray) else repr(value)
        digest.update(f"{type(value).__name__} {shown};".encode())
        if isinstance(value, np.ndarray):
            digest.update(np.ascontiguousarray(value).tobytes())
    return digest.hexdigest()
