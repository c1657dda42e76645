"""Soft bodies as signed distance fields: rounded cones, squashed along the axes, smoothly united."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .rig import Point, mirrored_name, mirrored_point

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Where no solid is near the distance is not computed; any value far above all blends serves, in metres.
FAR = 1e3


@dataclass(frozen=True)
class Solid:
    """A rounded cone, the hull of two balls, that belongs to a bone.

    Attributes
    ----------
    bone : str
        The bone that carries it.
    start, end : (3,) float
        Centres of the two balls; one ball if they are the same point.
    radii : (2,) float
        Their radii.
    scale : (3,) float
        Thickness along x, y and z relative to the radii.
    blend : float
        Width of the fillet towards the solids before it, in metres.
    """

    bone: str
    start: Point
    end: Point
    radii: tuple[float, float]
    scale: Point = (1.0, 1.0, 1.0)
    blend: float = 0.02

    @cached_property
    def bounds(self) -> Floats:
        """(2, 3) lower and upper corner of a box around it."""
        ends = np.array([self.start, self.end])
        reach = np.array(self.radii)[:, None] * np.array(self.scale)
        return np.stack([(ends - reach).min(axis=0), (ends + reach).max(axis=0)])

    def axis_point(self, points: Floats) -> tuple[Floats, Floats]:
        """Return where on the axis, 0..1, the nearest ball of the hull sits, and the offset from its centre.

        Parameters
        ----------
        points : (n, 3) float64

        Returns
        -------
        (n,) and (n, 3) float64
            The offset is measured in the space in which the solid has a round section.
        """
        shrink = 1.0 / np.array(self.scale)
        offset = (points - self.start) * shrink
        axis = (np.array(self.end) - self.start) * shrink
        length = np.linalg.norm(axis)
        if length == 0.0:
            return np.zeros(len(points)), offset
        along = offset @ (axis / length)
        across = np.sqrt(np.maximum(np.einsum("ij,ij->i", offset, offset) - along**2, 0.0))
        slope = np.clip((self.radii[0] - self.radii[1]) / length, -0.99, 0.99)
        # The normal of the cone through the point meets the axis here.
        share = np.clip((along - across * slope / np.sqrt(1.0 - slope**2)) / length, 0.0, 1.0)
        return share, offset - share[:, None] * axis

    def distance(self, points: Floats) -> tuple[Floats, Floats]:
        """Return the signed distance (n,), to first order where squashed, and its unit gradient (n, 3)."""
        share, offset = self.axis_point(points)
        length = np.sqrt(np.einsum("ij,ij->i", offset, offset))
        gradient = offset / np.maximum(length, 1e-12)[:, None] / np.array(self.scale)
        steepness = np.sqrt(np.einsum("ij,ij->i", gradient, gradient)) + 1e-12
        radius = self.radii[0] + share * (self.radii[1] - self.radii[0])
        return (length - radius) / steepness, gradient / steepness[:, None]


def mirrored_solid(solid: Solid) -> Solid:
    """Return the solid reflected in the plane x = 0, on the mirrored bone."""
    bone, start, end = mirrored_name(solid.bone), mirrored_point(solid.start), mirrored_point(solid.end)
    return replace(solid, bone=bone, start=start, end=end)


def with_mirrored_solids(solids: tuple[Solid, ...]) -> tuple[Solid, ...]:
    """Return the solids, each that lies to the left followed by its mirror image."""
    is_left = [solid.start[0] + solid.end[0] > 0.0 for solid in solids]
    pairs = ((solid, mirrored_solid(solid)) if left else (solid,) for solid, left in zip(solids, is_left, strict=True))
    return tuple(solid for pair in pairs for solid in pair)


@dataclass(frozen=True)
class Body:
    """The smooth union of solids, in their order.

    Attributes
    ----------
    solids : tuple of Solid
    symmetric : bool
        Whether it is its own mirror image in x = 0; the field is then exactly symmetric.
    """

    solids: tuple[Solid, ...]
    symmetric: bool = True

    @property
    def box_corners(self) -> Floats:
        """(8 n, 3) the corners of boxes around the solids."""
        boxes = np.array([solid.bounds for solid in self.solids])
        corners = np.array(np.meshgrid(*3 * [[0, 1]])).reshape(3, -1).T
        return boxes[:, corners, np.arange(3)].reshape(-1, 3)

    @cached_property
    def reaches(self) -> tuple[float, ...]:
        """How far from each solid it still matters for the surface: the widest fillet with a later one that is near."""
        low, high = np.array([solid.bounds for solid in self.solids]).swapaxes(0, 1)
        blends = np.array([solid.blend for solid in self.solids])
        gaps = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
        matters = np.triu(gaps < blends)
        return tuple(np.where(matters, blends, 0.0).max(axis=1).tolist())

    def distance(self, points: Floats, slack: float = FAR) -> tuple[Floats, Floats]:
        """Return the signed distance and its gradient.

        Parameters
        ----------
        points : (n, 3) float64
        slack : float
            The result is exact where it is smaller than this; elsewhere only its sign is right.

        Returns
        -------
        (n,) and (n, 3) float64
            Negative inside; the gradient has about unit length and points outwards.
        """
        folded = self._folded(points)
        coordinates = np.ascontiguousarray(folded.T)
        value, gradient = np.full(len(points), FAR), np.zeros((len(points), 3))
        for solid, reach in zip(self.solids, self.reaches, strict=True):
            near = _rows_near(coordinates, solid, slack + reach)
            value[near], gradient[near] = _smooth_union(
                value[near], gradient[near], *solid.distance(folded[near]), solid.blend
            )
        if self.symmetric:
            gradient[:, 0] *= np.sign(points[:, 0])
        return value, gradient

    def nearest_solid(self, points: Floats) -> tuple[Ints, Floats]:
        """Return the solid nearest to each point (n,) and its radius there (n,)."""
        nearest, radius = np.zeros(len(points), dtype=np.int64), np.zeros(len(points))
        smallest = np.full(len(points), np.inf)
        for i, solid in enumerate(self.solids):
            distance, _ = solid.distance(points)
            closer = distance < smallest - 1e-9
            share, _ = solid.axis_point(points[closer])
            nearest[closer], smallest[closer] = i, distance[closer]
            radius[closer] = solid.radii[0] + share * (solid.radii[1] - solid.radii[0])
        return nearest, radius

    def _folded(self, points: Floats) -> Floats:
        """Return the points, brought to the left side of a symmetric body."""
        return np.column_stack([np.abs(points[:, 0]), points[:, 1:]]) if self.symmetric else points


def _rows_near(coordinates: Floats, solid: Solid, margin: float) -> Ints:
    """Return which of the points, (3, n), lie in the solid's box widened by ``margin``."""
    near = np.ones(coordinates.shape[1], dtype=bool)
    for values, low, high in zip(coordinates, *solid.bounds, strict=True):
        near &= (values > low - margin) & (values < high + margin)
    return np.flatnonzero(near)


def _smooth_union(
    value: Floats, gradient: Floats, other: Floats, other_gradient: Floats, blend: float
) -> tuple[Floats, Floats]:
    """Return the union of two fields with a quadratic fillet where they differ by less than ``blend``."""
    overlap = np.maximum(blend - np.abs(value - other), 0.0) / blend
    share = np.where(value < other, 0.5 * overlap, 1.0 - 0.5 * overlap)[:, None]
    return np.minimum(value, other) - 0.25 * blend * overlap**2, gradient + share * (other_gradient - gradient)
