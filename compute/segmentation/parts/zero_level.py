"""The division along the zero level of an eigenfunction: into halves where no feature would cut, such as a torso."""

from functools import partial

import numpy as np

from ...fields.scalar_field import ScalarField, share_below
from ...surface.cleaning import Surface
from ...surface.mesh import Bools, Ints, TriangleMesh, connected_pieces, sum_by
from ...surface.ties import ROUNDING, evened, first_largest
from ..borders.edge_profile import edge_profile
from ..borders.level_set_borders import Polyline, cross_edges, part_of_border, trace_borders
from ..faces.arc_areas import HALVED
from ..faces.face_graph import FaceGraph, face_graph
from ..hierarchy.arc_tree import flat_tree
from .part_labels import Parts, Segmentation


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
    parts = Parts(
        id=ids,
        parent=np.zeros_like(ids),
        extremum=tip,
        saddle=np.full(len(ids), -1),
        area=sum_by(labels, mesh.areas)[1:],
        n_triangles=count[1:],
        mirror=np.full(len(ids), -1),
    )
    trace = partial(_zero_lines, field, mesh, surface, labels)
    return Segmentation(labels.astype(np.int32), parts, 0, _trace=trace)


def _zero_lines(field: ScalarField, mesh: TriangleMesh, surface: Surface, labels: Ints) -> tuple[Polyline, ...]:
    """Return the lines on which the field is zero, each as the border of the part above it."""
    hill, part = _hills(field, labels[surface.input_triangle])
    tree = flat_tree(len(part), is_of_maxima=True)
    profile = edge_profile(surface, field, (hill,), mesh.edges.vertices)
    cuts = [np.append(part, 0)]
    heights = np.append(np.zeros(len(part)), np.nan)
    return trace_borders(mesh, cross_edges(profile, (tree,), (heights,), cuts), part_of_border(cuts))


def _hills(field: ScalarField, label_of_surface: Ints) -> tuple[Ints, Ints]:
    """Return for each vertex of the net the piece above zero that it is on, and the part that each piece lies in.

    Vertices below zero get the number behind the last piece; pieces too small for a face have no part.
    """
    is_above = field.values > ROUNDING * field.value_range
    corners = field.net.triangles
    left, right = np.concatenate([corners[:, :2], corners[:, 1:]]).T
    both = is_above[left] & is_above[right]
    n = len(is_above)
    piece = connected_pieces(left[both], right[both], n)
    _, hill = np.unique(piece[is_above], return_inverse=True)
    n_hills = 1 + int(hill.max(initial=-1))
    of_vertex = np.full(n, n_hills)
    of_vertex[is_above] = hill
    inside = is_above[corners].all(axis=1)
    votes = np.zeros((n_hills, 1 + int(label_of_surface.max())))
    np.add.at(
        votes,
        (of_vertex[corners[inside, 0]], label_of_surface[field.net.triangle_of_surface[inside]]),
        field.net.areas[inside],
    )
    return of_vertex, first_largest(votes)


def _is_negative(field: ScalarField, surface: Surface, n_triangles: int) -> Bools:
    """Mask (T,) of the triangles of the input whose greater half is below zero."""
    heights = np.sort(field.values[field.net.triangles], axis=1)
    signed = field.net.areas * (2 * share_below(heights, np.zeros(len(heights))) - 1)
    triangle = surface.input_triangle[field.net.triangle_of_surface]
    # What symmetry halves is above.
    return sum_by(triangle, signed, n_triangles) > 2 * HALVED * sum_by(triangle, field.net.areas, n_triangles)


def _numbered_pieces(graph: FaceGraph, is_negative: Bools) -> Ints:
    left, right = graph.neighbours[is_negative[graph.neighbours[:, 0]] == is_negative[graph.neighbours[:, 1]]].T
    piece = connected_pieces(left, right, len(graph.area))[graph.stands_for]
    _, piece = np.unique(piece, return_inverse=True)
    by_area = np.argsort(-evened(sum_by(piece, graph.area)), kind="stable")
    return 1 + np.argsort(by_area, kind="stable")[piece]


def _extrema(field: ScalarField, label_of_surface: Ints, ids: Ints) -> Ints:
    """Return the net vertex of each piece at which the field is furthest from zero."""
    corners = field.net.triangles.ravel()
    label = np.repeat(label_of_surface[field.net.triangle_of_surface], 3)
    order = np.lexsort((-evened(np.abs(field.values[corners])), label))
    return corners[order[np.searchsorted(label[order], ids)]]
