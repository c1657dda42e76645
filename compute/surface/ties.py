"""Ties: numbers that differ by rounding alone count as equal, and the first of them wins.

Processors add and multiply in different orders, so the last digits of the same numbers differ. Where shapes are
symmetric or regular, two candidates are equal up to those digits, which must not decide about parts and joints.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Numbers = NDArray[np.float64] | NDArray[np.int64]

# Numbers nearer to each other than this fraction of their size are equal. From processor to processor fields differ by
# 1e-11 of their range and, where eigenvalues are nearly equal, by 1e-9; pairs below 1e-4 of it are noise.
ROUNDING = 1e-8
# Candidates are equally good if they differ by less than this fraction: what is computed from a field, such as the
# length of a level set, is rounded more. A wide margin costs nothing, as one of the candidates is taken anyway.
CHOICE = 1e-6


def evened(values: Numbers, size: float | None = None) -> NDArray[np.float64]:
    """Return values that are equal where they tie: each as the lowest of those that it ties with.

    Parameters
    ----------
    values : (n,) float64
    size : float, optional
        What rounding is a fraction of, such as the range of a field; the largest absolute value if None.
    """
    values = np.asarray(values, dtype=np.float64)
    if not len(values):
        return values
    size = float(np.abs(values).max()) if size is None else size
    order = np.argsort(values)
    rising = values[order]
    is_apart = np.append(True, np.diff(rising) > ROUNDING * size)
    even = np.empty_like(values)
    even[order] = rising[is_apart][np.cumsum(is_apart) - 1]
    return even


def first_least(values: Numbers) -> NDArray[np.int64]:
    """Return the place of the least of values (..., n) along the last axis, the first of those that tie."""
    margin = CHOICE * np.abs(values).max(axis=-1, keepdims=True)
    return np.argmax(values <= values.min(axis=-1, keepdims=True) + margin, axis=-1)


def first_largest(values: Numbers) -> NDArray[np.int64]:
    """Return the place of the largest of values (..., n) along the last axis, the first of those that tie."""
    return first_least(-values)


def first_nearest(tree: cKDTree, points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return for each point (p, 3) the nearest of the places in a tree, the first of those that are equally near."""
    reach = tree.query(points)[0] + CHOICE * (tree.maxes - tree.mins).max()
    return np.array([min(near) for near in tree.query_ball_point(points, reach)], dtype=np.int64)
