"""The characters are closed quad meshes of known topology, symmetric where they should be."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from examples import hand, handles, humanoid, octopus


def directed_edges(quads):
    return np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)


def n_pieces(ends, n):
    return connected_components(coo_array((np.ones(len(ends)), ends.T), shape=(n, n)), directed=False)[0]


def test_every_edge_is_run_through_once_in_each_direction(character):
    edges = directed_edges(character.quads)
    assert len(np.unique(edges, axis=0)) == len(edges)
    np.testing.assert_array_equal(np.unique(edges, axis=0), np.unique(edges[:, ::-1], axis=0))


def test_the_quads_around_a_vertex_form_one_fan(character):
    edges = directed_edges(character.quads)
    # Corners, numbered like the edges that start there; two are joined if they share a vertex and an edge at it.
    corner_before = np.arange(len(edges)).reshape(-1, 4)[:, [3, 0, 1, 2]].ravel()
    opposite = np.lexsort(edges.T)[np.argsort(np.lexsort(edges[:, ::-1].T))]
    joined = np.stack([np.arange(len(edges)), opposite[corner_before]], axis=1)
    np.testing.assert_array_equal(*edges[joined][:, :, 0].T)
    assert n_pieces(joined, len(edges)) == len(character.vertices)


def test_the_mesh_is_one_piece(character):
    assert n_pieces(directed_edges(character.quads), len(character.vertices)) == 1


@pytest.mark.parametrize("genus", [1, 2, 3])
def test_a_chain_of_rings_has_euler_characteristic_two_minus_twice_their_number(genus):
    mesh = handles(genus)
    n_edges = len(directed_edges(mesh.quads)) // 2
    assert len(mesh.vertices) - n_edges + len(mesh.quads) == 2 - 2 * genus


@pytest.mark.parametrize("make", [humanoid, octopus, hand])
@pytest.mark.parametrize("n_vertices", [4000, 5300, 12000])
def test_a_body_has_no_handles_and_about_as_many_vertices_as_wished(make, n_vertices):
    mesh = make(n_vertices)
    assert len(mesh.vertices) - len(mesh.quads) == 2
    assert abs(len(mesh.vertices) / n_vertices - 1) < 0.05


def test_faces_look_outwards(character):
    corners = character.vertices[character.quads]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    _, outwards = character.plan.body.distance(corners.mean(axis=1))
    agreement = np.einsum("ij,ij->i", normals, outwards) / np.linalg.norm(normals, axis=1)
    assert np.mean(agreement > 0.5) > 0.995


def test_the_first_diagonal_is_the_shorter_one(character):
    corners = character.vertices[character.quads]
    first, second = (np.linalg.norm(corners[:, i] - corners[:, i + 2], axis=1) for i in (0, 1))
    assert (first <= second * (1 + 1e-6)).all()


def test_quads_are_near_squares(character):
    corners = character.vertices[character.quads]
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    assert np.percentile(sides.min(axis=1) / sides.max(axis=1), 5) > 0.5


def test_the_left_half_is_the_mirror_image_of_the_right_half(symmetric_character):
    vertices, mirror = symmetric_character.vertices, symmetric_character.mirror_of_vertex
    np.testing.assert_array_equal(vertices[mirror], vertices * (-1, 1, 1))
    np.testing.assert_array_equal(mirror[mirror], np.arange(len(vertices)))
    mirrored = np.unique(np.sort(mirror[symmetric_character.quads], axis=1), axis=0)
    np.testing.assert_array_equal(mirrored, np.unique(np.sort(symmetric_character.quads, axis=1), axis=0))


def test_making_it_again_gives_the_same_character(coarse_humanoid):
    again = humanoid(4000)
    for name in ("vertices", "quads", "weights"):
        np.testing.assert_array_equal(getattr(again, name), getattr(coarse_humanoid, name))


@pytest.mark.parametrize(("make", "n_vertices"), [(humanoid, 1500), (octopus, 1000), (hand, 500)])
def test_too_few_vertices_are_refused(make, n_vertices):
    with pytest.raises(ValueError, match="vertices"):
        make(n_vertices)


def test_a_body_without_rings_is_refused():
    with pytest.raises(ValueError, match="at least one"):
        handles(0)
