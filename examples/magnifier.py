"""Space stretched around hands and faces, so that a regular grid meshes them finer than the rest."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# The table of distances goes on to here, in metres: farther than any body reaches.
FAR_AWAY = 1e3


@dataclass(frozen=True)
class Magnifier:
    """A magnification of space that grows with the distance from a coordinate plane, equally on both sides of it.

    Attributes
    ----------
    axis : int
        The normal of the plane: 0, 1 or 2.
    begin, full : float
        Distances from the plane between which it grows from 1 to ``factor``.
    factor : float
        Magnification from ``full`` on.
    centre : (3,) float
        Across the axis, the line through this point stays in place.
    """

    axis: int
    begin: float
    full: float
    factor: float
    centre: tuple[float, float, float]

    def magnified(self, points: Floats) -> Floats:
        """Return where points go, (n, 3)."""
        along = points[:, self.axis]
        moved = self.centre + self._factor_at(np.abs(along))[:, None] * (points - self.centre)
        moved[:, self.axis] = np.sign(along) * np.interp(np.abs(along), *self._table)
        return moved

    def shrunk(self, points: Floats) -> Floats:
        """Return where magnified points came from, (n, 3)."""
        along = points[:, self.axis]
        distance = np.interp(np.abs(along), *self._table[::-1])
        moved = self.centre + (points - self.centre) / self._factor_at(distance)[:, None]
        moved[:, self.axis] = np.sign(along) * distance
        return moved

    def _factor_at(self, distance: Floats) -> Floats:
        share = np.clip((distance - self.begin) / (self.full - self.begin), 0.0, 1.0)
        return 1.0 + (self.factor - 1.0) * share**2 * (3.0 - 2.0 * share)

    @cached_property
    def _table(self) -> tuple[Floats, Floats]:
        """Distances before and after, finely spaced up to ``full``."""
        distance = np.linspace(0.0, self.full, 2001)
        factor = self._factor_at(distance)
        moved = np.concatenate([[0.0], np.cumsum(0.5 * (factor[1:] + factor[:-1]) * np.diff(distance))])
        return np.append(distance, self.full + FAR_AWAY), np.append(moved, moved[-1] + self.factor * FAR_AWAY)


@dataclass(frozen=True)
class Magnifiers:
    """Magnifications one after the other; none leaves space as it is."""

    stages: tuple[Magnifier, ...] = ()

    def magnified(self, points: Floats) -> Floats:
        """Return where points go, (n, 3)."""
        for stage in self.stages:
            points = stage.magnified(points)
        return points

    def shrunk(self, points: Floats) -> Floats:
        """Return where magnified points came from, (n, 3)."""
        for stage in self.stages[::-1]:
            points = stage.shrunk(points)
        return points
