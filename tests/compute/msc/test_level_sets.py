"""Level sets as polylines."""

import numpy as np

from compute.msc.morse_smale import MorseSmaleComplex
from tests.compute.msc.surfaces import noise, topology
from tests.shapes import icosphere, rectangle, torus


def test_level_set_of_a_sphere_is_a_circle():
    mesh = icosphere(5)
    (line,) = MorseSmaleComplex(topology(mesh, mesh.vertices[:, 2] + 1e-7)).level_lines(0.5)
    np.testing.assert_array_equal(line[0], line[-1])
    length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    np.testing.assert_allclose(length, 2 * np.pi * np.sqrt(0.75), rtol=2e-3)
    np.testing.assert_allclose(line[:, 2], 0.5, atol=1e-6)


def test_level_set_of_a_standing_torus_is_two_circles():
    mesh = torus(48, 24)
    lines = MorseSmaleComplex(topology(mesh, mesh.vertices[:, 0])).level_lines(0.01)
    assert len(lines) == 2
    for line in lines:
        length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        np.testing.assert_allclose(length, 2 * np.pi, rtol=0.01)


def test_open_lines_run_from_side_to_side():
    mesh = rectangle(10, 6)
    (line,) = MorseSmaleComplex(topology(mesh, mesh.vertices[:, 0])).level_lines(0.73)
    np.testing.assert_allclose(line[:, 0], 0.73)
    assert sorted(line[[0, -1], 1]) == [0, 1]


def test_steps_of_a_line_stay_within_triangles():
    mesh = icosphere(3)
    values = noise(mesh, np.random.default_rng(0))
    longest = np.linalg.norm(np.diff(mesh.vertices[mesh.edges.vertices], axis=1), axis=2).max()
    for line in MorseSmaleComplex(topology(mesh, values)).level_lines(0.1):
        assert np.linalg.norm(np.diff(line, axis=0), axis=1).max() <= longest
