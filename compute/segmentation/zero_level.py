"""The division along the zero level of an eigenfunction: into halves where no feature would cut, such as a torso."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..fields import ScalarField
from ..mesh import Bools, Ints, TriangleMesh
from ..surface import Surface
from .arc_areas import share_below
from .faces import FaceGraph, face_graph, sum_by
from .parts import Parts, Segmentation


def divide_at_zero(field: ScalarField, mesh: TriangleMesh, surface: Surface) -> Segmentation:
    """Divide a mesh into the connected pieces on which a field has one sign; by falling area, from 1.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 5.1.
    """
    graph = face_graph(mesh, surface, np.arange(len(mesh.triangles)))
    labels = _numbered_pieces(graph, _is_negative(field, surface, len(mesh.triangles)))
    count = np.bincount(labels)
    ids = np.arange(1, len(count))
    tip = _extrema(field, labels[surface.input_triangle], ids)
    none = np.full(len(ids), -1)
    parts = Parts(ids, np.zeros_like(ids), tip, none, sum_by(labels, mesh.areas)[1:], count[1:])
    return Segmentation(labels.astype(np.int32), parts, 0)


def _is_negative(field: ScalarField, surface: Surface, n_triangles: int) -> Bools:
    """Tell (T,) whether the greater half of each triangle of the input is below zero."""
    heights = np.sort(field.values[field.net.triangles], axis=1)
    signed = field.net.areas * (2 * share_below(heights, np.zeros(len(heights))) - 1)
    return sum_by(surface.input_triangle[field.net.triangle_of_surface], signed, n_triangles) > 0


def _numbered_pieces(graph: FaceGraph, is_negative: Bools) -> Ints:
    left, right = graph.neighbours[is_negative[graph.neighbours[:, 0]] == is_negative[graph.neighbours[:, 1]]].T
    n_faces = len(graph.area)
    joined = coo_array((np.ones(len(left), dtype=bool), (left, right)), shape=(n_faces, n_faces))
    piece = connected_components(joined, directed=False)[1][graph.stands_for]
    _, piece = np.unique(piece, return_inverse=True)
    by_area = np.argsort(-sum_by(piece, graph.area), kind="stable")
    return 1 + np.argsort(by_area, kind="stable")[piece]


def _extrema(field: ScalarField, label_of_surface: Ints, ids: Ints) -> Ints:
    """Return the net vertex of each piece at which the field is furthest from zero."""
    corners = field.net.triangles.ravel()
    label = np.repeat(label_of_surface[field.net.triangle_of_surface], 3)
    order = np.lexsort((-np.abs(field.values[corners]), label))
    return corners[order[np.searchsorted(label[order], ids)]]
