"""Slices of an ellipsoid along its axis, whose girths and places are known."""

import numpy as np
import pytest

from compute import TriangleMesh, analyze, reeb_graph
from compute.skeletons.slices import centres_at_rest, centres_in_pose, slice_arcs
from tests.shapes import icosphere


@pytest.fixture(scope="module")
def analysis():
    sphere = icosphere(4)
    return analyze(TriangleMesh(sphere.vertices * [1, 1, 3], sphere.triangles), field=1, order=1)


@pytest.fixture(scope="module")
def slices(analysis):
    upper = (analysis.mesh.vertices[analysis.mesh.triangles].mean(axis=1)[:, 2] > 0).astype(np.int32)
    return slice_arcs(analysis, reeb_graph(analysis), upper)


def test_slices_lie_on_the_axis_in_their_order(analysis, slices):
    centres = slices.means(centres_at_rest(analysis))
    assert np.abs(centres[:, :2]).max() < 0.02
    steps = np.diff(centres[slices.of_arc(0), 2])
    assert (steps > 0).all() or (steps < 0).all()


def test_radii_are_on_average_those_of_the_ellipsoid(analysis, slices):
    """Single slices follow whole triangles, which blurs their girths."""
    z = slices.means(centres_at_rest(analysis))[:, 2]
    inner = np.abs(z) < 2
    ratio = slices.radius[inner] / np.sqrt(1 - z[inner] ** 2 / 9)
    assert np.median(ratio) == pytest.approx(1, abs=0.05)


def test_slices_of_an_arc_have_equal_areas(analysis, slices):
    area = np.bincount(slices.of_triangle, analysis.net.areas)
    assert area.max() < 2.5 * area.min()
    np.testing.assert_allclose(slices.length * slices.girth, area)
    assert area.sum() == pytest.approx(analysis.mesh.areas.sum())


def test_each_slice_has_the_label_of_most_of_it(analysis, slices):
    z = slices.means(centres_at_rest(analysis))[:, 2]
    clear = np.abs(z) > 0.2
    np.testing.assert_array_equal(slices.part[clear], z[clear] > 0)


def test_centres_move_with_the_vertices(analysis):
    matrix = np.array([[2, 0.3, 0], [0, 1, 0.1], [0.5, 0, 1]])
    moved = centres_in_pose(analysis, analysis.mesh.vertices @ matrix.T + [1, 2, 3])
    np.testing.assert_allclose(moved, centres_at_rest(analysis) @ matrix.T + [1, 2, 3], atol=1e-9)


def test_slices_of_a_level_field_are_no_wider_than_the_shape(analysis):
    mesh = analysis.mesh
    # The lower half is level.
    stepped = analyze(mesh, field=np.maximum(mesh.vertices[:, 2], 0.0))
    labels = (mesh.vertices[mesh.triangles].mean(axis=1)[:, 2] > 1).astype(np.int32)
    radius = slice_arcs(stepped, reeb_graph(stepped), labels).radius
    assert radius.max() <= np.linalg.norm(np.ptp(mesh.vertices, axis=0)) / 2
    assert radius.min() > 0
