"""A picture as an array, and smooth shapes drawn into it; knows nothing of Blender."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

# Samples across a pixel for filled triangles.
SAMPLES = 4


class Canvas:
    """An opaque picture in sRGB; x runs to the right and y up, in pixels, as Blender's images do.

    Attributes
    ----------
    pixels : (height, width, 3) float32
    """

    def __init__(self, width: int, height: int, background: Sequence[float]) -> None:
        self.pixels = np.empty((height, width, 3), dtype=np.float32)
        self.pixels[:] = background

    def line(self, points: np.ndarray, colour: Sequence[float], width: float = 1.5, opacity: float = 1.0) -> None:
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
                here = coverage[near_rows[0] - rows[0] :, near_columns[0] - columns[0] :][: len(y), : len(x[0])]
                np.maximum(here, _coverage(_distance_to_segment(x, y, start, stop) - width / 2), out=here)
        self._blend(rows, columns, colour, opacity * coverage)

    def dashes(self, start: Sequence[float], stop: Sequence[float], colour: Sequence[float], width: float) -> None:
        """Draw a dashed straight line."""
        start, stop = np.asarray(start, dtype=float), np.asarray(stop, dtype=float)
        n_dashes = max(int(np.linalg.norm(stop - start) / (6 * width)), 1)
        for k in range(n_dashes):
            ends = start + np.outer([k, k + 0.5], (stop - start) / n_dashes)
            self.line(ends, colour, width)

    def disk(self, centre: Sequence[float], radius: float, colour: Sequence[float], opacity: float = 1.0) -> None:
        """Draw a filled circle."""
        centre = np.asarray(centre, dtype=float)
        rows, columns = self._window(centre - radius - 1, centre + radius + 1)
        x, y = np.meshgrid(columns + 0.5, rows + 0.5)
        self._blend(rows, columns, colour, opacity * _coverage(np.hypot(x - centre[0], y - centre[1]) - radius))

    def diamond(self, centre: Sequence[float], radius: float, colour: Sequence[float]) -> None:
        """Draw a filled square on its tip."""
        self.polygon(np.asarray(centre) + radius * np.array([[1, 0], [0, 1], [-1, 0], [0, -1]]), colour)

    def rectangle(self, low: Sequence[float], high: Sequence[float], colour: Sequence[float]) -> None:
        """Fill an upright rectangle."""
        (left, bottom), (right, top) = low, high
        self.polygon(np.array([[left, bottom], [right, bottom], [right, top], [left, top]]), colour)

    def polygon(self, corners: np.ndarray, colour: Sequence[float]) -> None:
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

    def triangles(self, corners: np.ndarray, colour: Sequence[float], opacity: float = 1.0) -> None:
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

    def _window(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the rows and columns that a box touches."""
        size = np.array(self.pixels.shape[1::-1])
        first = np.clip(np.floor(low), 0, size).astype(int)
        last = np.clip(np.ceil(high), 0, size).astype(int)
        return np.arange(first[1], last[1]), np.arange(first[0], last[0])

    def _blend(self, rows: np.ndarray, columns: np.ndarray, colour: Sequence[float], coverage: np.ndarray) -> None:
        if len(rows) and len(columns):
            window = self.pixels[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
            window += coverage[..., None].astype(np.float32) * (np.asarray(colour, dtype=np.float32) - window)


def _coverage(distance: np.ndarray) -> np.ndarray:
    """Return how much of a pixel lies inside, for signed distances of its centre from the rim."""
    return np.clip(0.5 - distance, 0, 1)


def _distance_to_segment(x: np.ndarray, y: np.ndarray, start: np.ndarray, stop: np.ndarray) -> np.ndarray:
    along = stop - start
    place = ((x - start[0]) * along[0] + (y - start[1]) * along[1]) / max(float(along @ along), 1e-12)
    place = np.clip(place, 0, 1)
    return np.hypot(x - start[0] - place * along[0], y - start[1] - place * along[1])


def _fill(inside: np.ndarray, triangle: np.ndarray) -> None:
    """Mark the samples inside one triangle, its rim included."""
    size = np.array(inside.shape[::-1])
    first = np.clip(np.floor(triangle.min(axis=0)), 0, size).astype(int)
    last = np.clip(np.ceil(triangle.max(axis=0)) + 1, 0, size).astype(int)
    x = np.arange(first[0], last[0]) + 0.5
    y = (np.arange(first[1], last[1]) + 0.5)[:, None]
    (a, b, c), winding = triangle.tolist(), np.linalg.det(triangle[1:] - triangle[0])
    if winding < 0:
        b, c = c, b
    window = inside[first[1] : last[1], first[0] : last[0]]
    window |= (_side(a, b, x, y) >= 0) & (_side(b, c, x, y) >= 0) & (_side(c, a, x, y) >= 0)


def _side(start: list[float], stop: list[float], x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return positive numbers to the left of a line."""
    return (stop[0] - start[0]) * (y - start[1]) - (stop[1] - start[1]) * (x - start[0])
