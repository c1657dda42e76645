import numpy as np
import pytest

from compute import MeshError, TriangleMesh
from tests.shapes import icosphere, joined, rectangle, tetrahedron


def test_area_of_a_regular_tetrahedron():
    assert tetrahedron().areas.sum() == pytest.approx(np.sqrt(3))


@pytest.mark.parametrize("scale", [1e-30, 1e30])
def test_areas_neither_underflow_nor_overflow(scale):
    mesh = TriangleMesh(tetrahedron().vertices * scale, tetrahedron().triangles)
    assert mesh.areas.sum() / scale**2 == pytest.approx(np.sqrt(3))


def test_edges_of_a_closed_surface_have_two_triangles():
    edges = icosphere(1).edges
    assert len(edges.vertices) == 120
    assert (edges.n_triangles == 2).all()
    assert len(edges.neighbours) == 120


def test_neighbours_share_the_edge_they_say():
    mesh = rectangle(3, 2)
    for (left, right), edge in zip(mesh.edges.neighbours, mesh.edges.shared, strict=True):
        common = set(mesh.triangles[left]) & set(mesh.triangles[right])
        assert common == set(mesh.edges.vertices[edge])


def test_components_are_numbered_by_falling_area():
    small = TriangleMesh(icosphere(1).vertices * 0.1 + 5, icosphere(1).triangles)
    mesh = joined(small, icosphere(2))
    assert mesh.component_of_triangle.tolist() == [1] * 80 + [0] * 320


@pytest.mark.parametrize(
    ("vertices", "triangles", "sentence"),
    [
        (np.zeros((3, 3)), np.zeros((0, 3), int), "no faces"),
        (np.eye(3), [[0, 1, 3]], "does not exist"),
        (np.eye(3), [[0, 1, -1]], "does not exist"),
        (np.array([[0, 0, np.nan], [1, 0, 0], [0, 1, 0]]), [[0, 1, 2]], "finite"),
        (np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]]), [[0, 1, 2]], "no area"),
        (np.eye(2), [[0, 1, 1]], "shape"),
        (np.eye(3), [[0.0, 1.0, 2.0]], "numbers of shape"),
    ],
)
def test_refuses_what_is_no_surface(vertices, triangles, sentence):
    with pytest.raises(MeshError, match=sentence):
        TriangleMesh(vertices, triangles)


def test_an_unused_vertex_may_be_anywhere():
    vertices = np.vstack([tetrahedron().vertices, [[np.nan, np.inf, 0]]])
    assert TriangleMesh(vertices, tetrahedron().triangles).areas.sum() == pytest.approx(np.sqrt(3))


def test_a_mesh_whose_areas_would_be_no_numbers_is_refused():
    with pytest.raises(MeshError, match="too large to be computed with"):
        TriangleMesh(1e200 * icosphere(0).vertices, icosphere(0).triangles)
    with pytest.raises(MeshError, match="have no area"):
        TriangleMesh(1e-200 * icosphere(0).vertices, icosphere(0).triangles)
