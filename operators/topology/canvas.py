"""A picture as an array, and smooth shapes drawn into it; knows nothing of Blender."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
# x and y in pixels, or red, green and blue.
Numbers = Sequence[float] | Floats

# Samples across a pixel for filled triangles.
SAMPLES = 4


class Canvas:
    """An opaque picture in sRGB; x runs to the right and y up, in pixels, as Blender's images do.

    Attributes
    ----------
    pixels : (height, width, 3) float32
    """

    def __init__(self, width: int, height: int, background: Numbers) -> None:
        self.pixels = np.empty((height, width, 3), dtype=np.float32)
        self.pixels[:] = background

    def line(self, points: Floats, colour: Numbers, width: float = 1.5, opacity: float = 1.0) -> None:
        """Draw a line through (n, 2) points with round ends."""
        points = np.asarray(points, dtype=float)
        reach = width / 2 + 1
        rows, columns = self._window(points.min(axis=0) - reach, points.max(axis=0) + reach)
        coverage = np.zeros((len(rows), len(columns)))
        for start, stop in pairwise(points):
            low, high = np.minimum(start, stop) - reach, np.maximum(start, stop) + reach
            near_rows, near_columns = self._window(low, high)
            if len(near_rows) and len(near_columns):
                x, y = np.meshgrid(near_columns + 0.5, near_rows + 0.5)
                near = coverage[near_rows[0] - rows[0] :, near_columns[0] - columns[0] :][: len(y), : len(x[0])]
                np.maximum(near, _coverage(_distance_to_segment(x, y, start, stop) - width / 2), out=near)
        self._blend(rows, columns, colour, opacity * coverage)

    def dashes(self, start: Numbers, stop: Numbers, colour: Numbers, width: float) -> None:
        """Draw a dashed straight line."""
        origin = np.asarray(start, dtype=float)
        along = np.asarray(stop, dtype=float) - origin
        n_dashes = max(int(np.linalg.norm(along) / (6 * width)), 1)
        for k in range(n_dashes):
            ends = origin + np.array([[k], [k + 0.5]]) * along / n_dashes
            self.line(ends, colour, width)

    def disk(self, centre: Numbers, radius: float, colour: Numbers, opacity: float = 1.0) -> None:
        """Draw a filled circle."""
        middle = np.asarray(centre, dtype=float)
        rows, columns = self._window(middle - radius - 1, middle + radius + 1)
        x, y = np.meshgrid(columns + 0.5, rows + 0.5)
        self._blend(rows, columns, colour, opacity * _coverage(np.hypot(x - middle[0], y - middle[1]) - radius))

    def diamond(self, centre: Numbers, radius: float, colour: Numbers) -> None:
        """Draw a filled square on its tip."""
        self.polygon(np.asarray(centre) + radius * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]]), colour)

    def rectangle(self, low: Numbers, high: Numbers, colour: Numbers) -> None:
        """Fill an upright rectangle."""
        (left, bottom), (right, top) = low, high
        self.polygon(np.array([[left, bottom], [right, bottom], [right, top], [left, top]]), colour)

    def polygon(self, corners: Floats, colour: Numbers) -> None:
        """Fill a convex polygon, (n, 2), in either winding."""
        rows, columns = self._window(corners.min(axis=0) - 1, corners.max(axis=0) + 1)
        x, y = np.meshgrid(columns + 0.5, rows + 0.5)
        middle = corners.mean(axis=0)
        inside = np.full(x.shape, np.inf)
        for start, stop in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            normal = np.array([start[1] - stop[1], stop[0] - start[0]])
            normal = normal * np.sign(normal @ (middle - start)) / max(float(np.linalg.norm(normal)), 1e-12)
            inside = np.minimum(inside, (x - start[0]) * normal[0] + (y - start[1]) * normal[1])
        self._blend(rows, columns, colour, _coverage(-inside))

    def triangles(self, corners: Floats, colour: Numbers, opacity: float = 1.0) -> None:
        """Fill (n, 3, 2) triangles; where they overlap or meet they count once."""
        if len(corners) == 0:
            return
        rows, columns = self._window(corners.min(axis=(0, 1)), corners.max(axis=(0, 1)))
        if not len(rows) or not len(columns):
            return
        inside = np.zeros((SAMPLES * len(rows), SAMPLES * len(columns)), dtype=bool)
        origin = np.array([columns[0], rows[0]])
        for triangle in (corners - origin) * SAMPLES:
            _fill(inside, triangle)
        coverage = inside.reshape(len(rows), SAMPLES, len(columns), SAMPLES).mean(axis=(1, 3))
        self._blend(rows, columns, colour, opacity * coverage)

    def _window(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """Return the rows and columns that a box touches."""
        size = np.array(self.pixels.shape[1::-1])
        first = np.clip(np.floor(low), 0, size).astype(np.int64)
        last = np.clip(np.ceil(high), 0, size).astype(np.int64)
        return np.arange(first[1], last[1]), np.arange(first[0], last[0])

    def _blend(self, rows: Ints, columns: Ints, colour: Numbers, coverage: Floats) -> None:
        if len(rows) and len(columns):
            window = self.pixels[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
            window += coverage[..., None].astype(np.float32) * (np.asarray(colour, dtype=np.float32) - window)


def _coverage(distance: Floats) -> Floats:
    """Return how much of a pixel lies inside, for signed distances of its centre from the rim."""
    return np.clip(0.5 - distance, 0, 1)


def _distance_to_segment(x: Floats, y: Floats, start: Floats, stop: Floats) -> Floats:
    along = stop - start
    place = ((x - start[0]) * along[0] + (y - start[1]) * along[1]) / max(float(along @ along), 1e-12)
    place = np.clip(place, 0, 1)
    return np.hypot(x - start[0] - place * along[0], y - start[1] - place * along[1])


def _fill(inside: NDArray[np.bool_], triangle: Floats) -> None:
    """Mark the samples inside one triangle, its rim included."""
    size = np.array(inside.shape[::-1])
    first = np.clip(np.floor(triangle.min(axis=0)), 0, size).astype(np.int64)
    last = np.clip(np.ceil(triangle.max(axis=0)) + 1, 0, size).astype(np.int64)
    x = np.arange(first[0], last[0]) + 0.5
    y = (np.arange(first[1], last[1]) + 0.5)[:, None]
    (a, b, c), winding = triangle.tolist(), np.linalg.det(triangle[1:] - triangle[0])
    if winding < 0:
        b, c = c, b
    window = inside[first[1] : last[1], first[0] : last[0]]
    window |= (_side(a, b, x, y) >= 0) & (_side(b, c, x, y) >= 0) & (_side(c, a, x, y) >= 0)


def _side(start: list[float], stop: list[float], x: Floats, y: Floats) -> Floats:
    """Return positive numbers to the left of a line."""
    return (stop[0] - start[0]) * (y - start[1]) - (stop[1] - start[1]) * (x - start[0])
