"""The field as hills over the faces: what lies beyond a border that is moved along it, or drawn across a part."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...msc.merge_tree import ends_of_paths
from ...surface.cleaning import Surface
from ...surface.mesh import Bools, Floats, Ints, TriangleMesh, sum_by
from .corrections import AWAY, BEFORE, BEYOND


@dataclass(frozen=True, eq=False)
class Hill:
    """A part that rises or falls from its border along the field, and whose border corrections move.

    Attributes
    ----------
    is_of_maxima : bool
        Whether it rises from its border.
    border : float
        The value of the field at its border.
    is_inside : (F,) bool
        Mask of its faces.
    """

    is_of_maxima: bool
    border: float
    is_inside: Bools

    @property
    def upward(self) -> int:
        """1 if the part lies above its border, -1 if below."""
        return 1 if self.is_of_maxima else -1


@dataclass(frozen=True, eq=False)
class Relief:
    """The field on a mesh with V vertices and F faces.

    Attributes
    ----------
    surface : Surface
    heights : (V,) float64
        The field on the vertices of the input.
    corners : (T', 3) int64
        Vertices of the analyzed triangles.
    face : (T',) int64
        The face each of them belongs to.
    n_faces : int
    stands_for : (F,) int64
        The analyzed face whose label each face takes: itself, or the nearest one if it is not analyzed.
    """

    surface: Surface
    heights: Floats
    corners: Ints
    face: Ints
    n_faces: int
    stands_for: Ints

    def sides(self, hill: Hill, level: float) -> Ints:
        """(F,) the side of a border at a level of the field that each face lies on, as seen from a part.

        It is ``AWAY``, ``BEFORE`` or ``BEYOND``.

        A face is in the part's reach if the steepest path up from it ends in the part, so that a border that is moved
        outward stops where the next hill begins.
        """
        reached = self._share(self.reach(hill)) >= 0.5
        height = self._share(hill.upward * self.heights)
        side = np.where(
            hill.is_inside | reached, np.where(reached & (height > hill.upward * level), BEYOND, BEFORE), AWAY
        )
        return side[self.stands_for]

    def reach(self, hill: Hill) -> Bools:
        """Mask (V,) of the vertices from which the steepest path up ends in the part."""
        ends_inside = np.zeros(len(self.heights), dtype=bool)
        ends_inside[self.corners[hill.is_inside[self.face]]] = True
        summit = self._ascents[hill.upward]
        return ends_inside[summit][self.surface.vertex_of_input]

    def peak(self, hill: Hill, faces: Bools) -> float:
        """Return the most extreme value of the field on some faces (F,)."""
        heights = hill.upward * self.heights[self.corners[faces[self.face]]]
        return hill.upward * float(heights.max())

    @cached_property
    def _ascents(self) -> dict[int, Ints]:
        """For either direction, the vertex (V,) where the steepest path ends."""
        return {upward: _summits(self.surface.mesh, upward * self.heights) for upward in (1, -1)}

    def _share(self, values: Floats | Bools) -> Floats:
        """Return the mean (F,) of vertex values over the corners of each face's triangles."""
        total = sum_by(np.repeat(self.face, 3), values[self.corners].ravel().astype(np.float64), self.n_faces)
        return total / np.maximum(3 * np.bincount(self.face, minlength=self.n_faces), 1)


def relief_of(surface: Surface, heights: Floats, face_of_triangle: Ints, stands_for: Ints) -> Relief:
    """Return the relief of a field.

    Parameters
    ----------
    surface : Surface
    heights : (V,) float64
    face_of_triangle : (T,) int64
        The polygon each triangle of the input belongs to.
    stands_for : (F,) int64
        As in the graph of the faces.
    """
    face = face_of_triangle[surface.input_triangle]
    return Relief(surface, heights, surface.mesh.triangles, face, len(stands_for), stands_for)


def _summits(mesh: TriangleMesh, heights: Floats) -> Ints:
    """Return the vertex (V,) that the path over the highest neighbours ends at; ties go by index."""
    rank = np.empty(len(heights), dtype=np.int64)
    rank[np.argsort(heights, kind="stable")] = np.arange(len(heights))
    low, high = mesh.edges.vertices.T
    start, stop = np.where(rank[low] < rank[high], (low, high), (high, low))
    # Of several values at one place, the last one stays: the highest.
    order = np.argsort(rank[stop])
    up = np.arange(len(heights))
    up[start[order]] = stop[order]
    return ends_of_paths(up)
