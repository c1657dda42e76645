"""Space stretched around the hands, so that a regular grid meshes them finer than the rest."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .solids import Body

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Magnifier:
    """A magnification of space that depends on the distance from the plane x = 0 and is the same on both sides.

    Attributes
    ----------
    begin, full : float
        Distances from the plane between which it grows from 1 to ``factor``.
    factor : float
        Magnification from ``full`` on; 1 leaves space as it is.
    centre : (2,) float
        The y and z that stay in place.
    """

    begin: float = 0.0
    full: float = 1.0
    factor: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)

    def magnified(self, points: Floats) -> Floats:
        """Return where points go, (n, 3)."""
        distance = np.abs(points[:, 0])
        across = self.centre + self._factor_at(distance)[:, None] * (points[:, 1:] - self.centre)
        along = np.sign(points[:, 0]) * np.interp(distance, *self._table)
        return np.column_stack([along, across])

    def shrunk(self, points: Floats) -> Floats:
        """Return where magnified points came from, (n, 3)."""
        distance = np.interp(np.abs(points[:, 0]), *self._table[::-1])
        across = self.centre + (points[:, 1:] - self.centre) / self._factor_at(distance)[:, None]
        return np.column_stack([np.sign(points[:, 0]) * distance, across])

    def magnified_bounds(self, body: Body) -> Floats:
        """(2, 3) lower and upper corner of a box around the magnified body."""
        boxes = np.array([solid.bounds for solid in body.solids])
        corners = np.array(np.meshgrid(*3 * [[0, 1]])).reshape(3, -1).T
        moved = self.magnified(boxes[:, corners, np.arange(3)].reshape(-1, 3))
        return np.stack([moved.min(axis=0), moved.max(axis=0)])

    def _factor_at(self, distance: Floats) -> Floats:
        share = np.clip((distance - self.begin) / (self.full - self.begin), 0.0, 1.0)
        return 1.0 + (self.factor - 1.0) * share**2 * (3.0 - 2.0 * share)

    @cached_property
    def _table(self) -> tuple[Floats, Floats]:
        """Distances before and after, finely spaced; the last interval reaches far beyond every body."""
        distance = np.linspace(0.0, self.full, 2001)
        factor = self._factor_at(distance)
        steps = 0.5 * (factor[1:] + factor[:-1]) * np.diff(distance)
        moved = np.concatenate([[0.0], np.cumsum(steps)])
        return np.append(distance, self.full + 1e3), np.append(moved, moved[-1] + 1e3 * self.factor)
