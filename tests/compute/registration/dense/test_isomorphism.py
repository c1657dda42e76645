"""The same faces under other numbers."""

import numpy as np
import pytest

from compute.registration.dense.isomorphism import isomorphism, may_be_isomorphic
from tests.compute.registration.shapes import shuffled
from tests.shapes import icosphere, joined, rectangle, torus


@pytest.mark.parametrize("mesh", [icosphere(2), torus(), rectangle(5, 3)], ids=["sphere", "torus", "sheet"])
def test_one_triangle_that_is_known_gives_all_vertices(mesh):
    other, order = shuffled(mesh)
    guess = np.zeros(len(order), dtype=np.int64)
    guess[other.triangles[7]] = order[other.triangles[7]]
    found = isomorphism(mesh.triangles, other.triangles, len(order), len(order), guess)
    np.testing.assert_array_equal(found, order)


def test_a_guess_without_a_true_triangle_leads_nowhere():
    mesh = icosphere(1)
    n = len(mesh.vertices)
    assert isomorphism(mesh.triangles, mesh.triangles, n, n, np.zeros(n, dtype=np.int64)) is None


def test_faces_of_which_one_edge_is_turned_are_no_isomorphism():
    mesh = icosphere(2)
    changed, n = mesh.triangles.copy(), len(mesh.vertices)
    valence = np.bincount(mesh.triangles.ravel())
    regular = next(row for row in changed if (valence[row] == 6).all())
    p, q, r = regular.tolist()
    other = next(k for k, row in enumerate(changed) if {p, q} < set(row.tolist()) and r not in row)
    (s,) = set(changed[other].tolist()) - {p, q}
    changed[(mesh.triangles == regular).all(axis=1)], changed[other] = [s, q, r], [s, r, p]
    assert isomorphism(mesh.triangles, changed, n, n, np.arange(n)) is None
    assert not may_be_isomorphic(mesh.triangles, changed)
    assert may_be_isomorphic(mesh.triangles, shuffled(mesh)[0].triangles)


def test_vertices_without_triangles_are_nothing():
    mesh = icosphere(0)
    assert isomorphism(mesh.triangles, mesh.triangles, 14, 14, np.arange(14)).tolist() == [*range(12), -1, -1]


def test_one_of_two_loose_parts_is_not_enough():
    both = joined(icosphere(1), torus())
    n = len(both.vertices)
    assert isomorphism(both.triangles, both.triangles, n, n, np.arange(n)) is None


def test_a_strip_with_an_end_is_followed_to_its_end():
    for n_long in range(2, 9):
        mesh = rectangle(n_long, 1)
        other, order = shuffled(mesh, seed=n_long)
        for seed in range(len(other.triangles)):
            guess = np.zeros(len(order), dtype=np.int64)
            guess[other.triangles[seed]] = order[other.triangles[seed]]
            found = isomorphism(mesh.triangles, other.triangles, len(order), len(order), guess)
            np.testing.assert_array_equal(found, order)
