"""The faces of the input as a graph: what labels are given to, and across what they touch."""

from dataclasses import dataclass

import numpy as np

from ...surface.cleaning import Surface
from ...surface.mesh import Floats, Ints, TriangleMesh, sum_by


@dataclass(frozen=True, eq=False)
class FaceGraph:
    """The faces of the input and which of them are neighbours.

    Attributes
    ----------
    area : (F,) float64
        Area of each face.
    stands_for : (F,) int64
        The analyzed face whose label each face takes: itself, or the nearest one if it is not analyzed.
    neighbours : (P, 2) int64
        Pairs of analyzed faces that share edges.
    length : (P,) float64
        Length of the edges they share.
    shared : (P,) int64
        The row of the surface's neighbouring triangles that each pair comes from.
    """

    area: Floats
    stands_for: Ints
    neighbours: Ints
    length: Floats
    shared: Ints


def face_graph(mesh: TriangleMesh, surface: Surface, face_of_triangle: Ints) -> FaceGraph:
    """Return the graph of the faces of an input mesh.

    Parameters
    ----------
    mesh : TriangleMesh
        The input, with T triangles.
    surface : Surface
        What of it was analyzed.
    face_of_triangle : (T,) int64
        The polygon each triangle belongs to; every polygon from 0 on has triangles.
    """
    area = sum_by(face_of_triangle, mesh.areas)
    face_of_surface = face_of_triangle[surface.input_triangle]
    stands_for = np.arange(len(area))
    is_analyzed = np.zeros(len(area), dtype=bool)
    is_analyzed[face_of_surface] = True
    if not is_analyzed.all():
        # A face that is not analyzed lies nearest to its first triangle's nearest one.
        _, first = np.unique(face_of_triangle, return_index=True)
        stands_for[~is_analyzed] = face_of_surface[surface.triangle_of_input[first[~is_analyzed]]]
    edges = surface.mesh.edges
    neighbours = face_of_surface[edges.neighbours]
    apart = neighbours[:, 0] != neighbours[:, 1]
    tails, heads = surface.mesh.vertices[edges.vertices[edges.shared][apart].T]
    return FaceGraph(area, stands_for, neighbours[apart], np.linalg.norm(heads - tails, axis=1), np.flatnonzero(apart))
