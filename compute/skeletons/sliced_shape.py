"""A shape cut into slices along its Reeb graph, in one or more poses: all that joints are found from."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import cKDTree

from ..analysis.analysis import Analysis
from ..analysis.readings import reeb_graph
from ..errors import LevelError, MeshError
from ..msc.reeb import ReebGraph
from ..surface.mesh import Floats, Ints, with_loose_inside
from ..surface.ties import first_nearest
from .interior import Interior
from .slices import Slices, centres_at_rest, centres_in_pose, slice_arcs

ONE_PART = "The mesh is one part at this level, so there are no limbs to put bones in; choose another level or mode."


@dataclass(frozen=True, eq=False)
class SlicedShape:
    """A shape with the slices of its Reeb graph; P poses, the first of which is the one at hand.

    Attributes
    ----------
    analysis : Analysis
    graph : ReebGraph
    slices : Slices
    interior : Interior
    poses : (P, V, 3) float64
        The vertices of the input.
    triangle_centres : (m, 3) float64
        Of the net's triangles in the first pose.
    centres : (P, S, 3) float64
        Of the slices; in the first pose pulled inside.
    """

    analysis: Analysis
    graph: ReebGraph
    slices: Slices
    interior: Interior
    poses: Floats
    triangle_centres: Floats
    centres: Floats

    @property
    def vertices(self) -> Ints:
        """The vertices that are analyzed."""
        return self.analysis.surface.mesh.used

    @cached_property
    def _vertex_tree(self) -> cKDTree:
        return cKDTree(self.analysis.mesh.vertices[self.vertices])

    def nearest_vertex(self, place: Floats) -> int:
        """Return the vertex of the surface that is nearest to a place (3,) in the first pose."""
        return int(self.vertices[first_nearest(self._vertex_tree, place[None])[0]])


def slice_shape(
    analysis: Analysis, labels: NDArray[np.int32], level: int | None, poses: Sequence[ArrayLike]
) -> SlicedShape:
    """Return a shape cut into slices along the Reeb graph of its field at a level.

    Parameters
    ----------
    analysis : Analysis
    labels : (T,) int32
        Part of each triangle of the input.
    level : int or None
        The default level if None.
    poses : sequence of (V, 3) float
        Further poses.

    Raises
    ------
    LevelError
        If the level does not exist or has one part only.
    MeshError
        If a pose does not have the vertices of the mesh.
    """
    graph = reeb_graph(analysis, level=level)
    if labels.min() == labels.max():
        raise LevelError(ONE_PART)
    slices = slice_arcs(analysis, graph, labels)
    interior = Interior.of(analysis.surface)
    further = _checked_poses(analysis, poses)
    at_rest = centres_at_rest(analysis)
    centres = [interior.centred(slices.means(at_rest), slices.radius)]
    centres += [slices.means(centres_in_pose(analysis, vertices)) for vertices in further]
    return SlicedShape(
        analysis=analysis,
        graph=graph,
        slices=slices,
        interior=interior,
        poses=np.stack([analysis.mesh.vertices, *further]),
        triangle_centres=at_rest,
        centres=np.stack(centres),
    )


def _checked_poses(analysis: Analysis, poses: Sequence[ArrayLike]) -> list[Floats]:
    """Return further poses as arrays, or name the first that has the wrong number of vertices."""
    mesh = analysis.mesh
    arrays = [np.asarray(pose, dtype=np.float64) for pose in poses]
    for number, pose in enumerate(arrays, start=1):
        if pose.shape != mesh.vertices.shape or not np.isfinite(pose[mesh.used]).all():
            n_vertices = len(mesh.vertices)
            raise MeshError(f"Pose {number} needs a finite place for each of the {n_vertices} vertices of the mesh.")
    return [with_loose_inside(pose, mesh.triangles) for pose in arrays]
