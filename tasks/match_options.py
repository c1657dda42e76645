"""Options of a matching: signs, alternative and mirror image, as the user asks for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .. import compute


@dataclass(frozen=True)
class GivenPoints:
    """Pairs of vertices of a source and a target.

    Attributes
    ----------
    vertices : tuple of (int, int)
    numbers : tuple of int
        By which they are told.
    """

    vertices: tuple[tuple[int, int], ...] = ()
    numbers: tuple[int, ...] = ()


NO_POINTS = GivenPoints()


@dataclass(frozen=True)
class MatchOptions:
    """Options of a matching.

    Attributes
    ----------
    flips : mapping of int to +1 or -1
        The signs of some of the reference's functions, from 1.
    alternative : int
        0 for the best matching.
    mirrored : bool
        Match the mirror image of the reference.
    points : GivenPoints
        Pairs of vertices, of the reference and the mesh, that belong together.
    """

    flips: Mapping[int, int] = field(default_factory=dict)
    alternative: int = 0
    mirrored: bool = False
    points: GivenPoints = NO_POINTS

    def point_warnings(self, matching: compute.Matching | None) -> tuple[str, ...]:
        """Return a sentence for each of the points that contradicts a matching, and one where they overrule another."""
        if matching is None:
            return ()
        return compute.point_warnings(matching.point_gaps, matching.sure_without_points, self.points.numbers)
