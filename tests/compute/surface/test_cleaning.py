import numpy as np
import pytest

from compute import MeshError, TriangleMesh
from compute.choices import SHELLS
from compute.surface.cleaning import analyzed_surface, clean_surface
from tests.shapes import icosphere, joined, rectangle, tetrahedron


def as_soup(mesh: TriangleMesh) -> TriangleMesh:
    """Give every triangle three vertices of its own."""
    return TriangleMesh(mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(3 * len(mesh.triangles)).reshape(-1, 3))


def test_a_clean_mesh_is_analyzed_as_it_is():
    surface = clean_surface(icosphere(1))
    np.testing.assert_array_equal(surface.mesh.triangles, icosphere(1).triangles)
    np.testing.assert_array_equal(surface.triangle_of_input, np.arange(80))


def test_a_soup_is_welded_into_the_closed_surface():
    surface = clean_surface(as_soup(icosphere(1)))
    assert (surface.mesh.edges.n_triangles == 2).all()
    assert len(np.unique(surface.mesh.triangles)) == 42


def test_closed_shells_that_touch_in_a_point_stay_apart():
    touching = TriangleMesh(icosphere(1).vertices * -1 + 2 * icosphere(1).vertices[0], icosphere(1).triangles)
    assert clean_surface(joined(icosphere(1), touching)).n_components == 2


def test_the_largest_component_is_analyzed_and_the_others_follow_what_is_nearest():
    eye = TriangleMesh(0.1 * icosphere(1).vertices + [0, 0, 1], icosphere(1).triangles)
    surface = clean_surface(joined(eye, icosphere(2)))
    assert len(surface.mesh.triangles) == 320
    centres = surface.mesh.vertices[surface.mesh.triangles].mean(axis=1)
    assert centres[surface.triangle_of_input[:80], 2].min() > 0.8


def test_repeated_and_collapsed_triangles_are_left_out():
    plain = rectangle(2, 2)
    extra = np.vstack([plain.triangles, plain.triangles[:1, ::-1], [[0, 0, 1]]])
    surface = clean_surface(TriangleMesh(plain.vertices, extra))
    assert len(surface.mesh.triangles) == 8
    assert surface.triangle_of_input[8] == 0


def test_a_flat_triangle_with_three_corners_stays_so_that_the_surface_does_not_tear():
    # The middle of the long side belongs to the flat triangle (0, 1, 2) alone on that side.
    vertices = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 1, 0], [1, -1, 0]])
    mesh = TriangleMesh(vertices, [[0, 1, 3], [1, 2, 3], [0, 2, 1], [0, 4, 2]])
    surface = clean_surface(mesh)
    assert len(surface.mesh.triangles) == 4
    assert surface.n_components == 1


def test_edges_without_length_are_welded():
    """A tip of three vertices in one place, which collapsed faces join."""
    cone = icosphere(1)
    tip = cone.triangles[0]
    vertices = cone.vertices.copy()
    vertices[tip] = vertices[tip].mean(axis=0)
    surface = clean_surface(TriangleMesh(vertices, cone.triangles))
    assert len(set(surface.vertex_of_input[tip])) == 1
    # The face itself and the three beside it are gone.
    assert len(surface.mesh.triangles) == 80 - 4
    assert (surface.mesh.edges.n_triangles == 2).all()


def test_a_component_can_be_chosen():
    small = TriangleMesh(tetrahedron().vertices + 9, tetrahedron().triangles)
    assert len(clean_surface(joined(icosphere(1), small), component=1).mesh.triangles) == 4


def test_refuses_a_component_that_does_not_exist():
    with pytest.raises(MeshError, match="components 0 to 0"):
        clean_surface(icosphere(0), component=1)


def test_refuses_loose_triangles():
    with pytest.raises(MeshError, match="single triangle"):
        clean_surface(TriangleMesh(np.eye(3), [[0, 1, 2]]))


def test_a_mesh_that_needs_no_cleaning_keeps_what_it_knows_of_itself():
    """Edges and areas of a large mesh take a good part of its analysis."""
    mesh = icosphere(2)
    assert all(analyzed_surface(mesh, shells).mesh is mesh for shells in SHELLS)
    twice = TriangleMesh(mesh.vertices, np.vstack([mesh.triangles, mesh.triangles[:1]]))
    np.testing.assert_array_equal(analyzed_surface(twice, "largest").mesh.triangles, mesh.triangles)
