"""Borders along edges: least cuts whose answer is known."""

import numpy as np

from compute.segmentation.borders.edge_borders import shortened_borders
from compute.segmentation.faces.face_graph import face_graph
from compute.surface.cleaning import clean_surface
from tests.shapes import icosphere, rectangle


def strip():
    """A rectangle of 20 by 6 square cells."""
    mesh = rectangle(20, 6, 20.0, 6.0)
    cell = np.tile(np.arange(120), 2)
    return face_graph(mesh, clean_surface(mesh), cell), np.arange(120) // 6, np.arange(120) % 6


def test_a_zigzag_becomes_a_straight_line():
    graph, x, y = strip()
    labels = (x + (y % 2) > 10).astype(np.int32)
    moved = shortened_borders(labels, graph)
    np.testing.assert_array_equal(moved, x > x[moved == 0].max())
    assert abs(x[moved == 0].max() - 10) <= 1


def test_a_straight_border_stays():
    graph, x, _ = strip()
    labels = np.digitize(x, [7, 13]).astype(np.int32)
    np.testing.assert_array_equal(shortened_borders(labels, graph), labels)


def test_every_label_stays_somewhere():
    graph, x, y = strip()
    labels = np.where(x == 10, np.where(y == 0, 2, 1), np.where(x < 10, 0, 3)).astype(np.int32)
    assert set(shortened_borders(labels, graph)) == {0, 1, 2, 3}


def test_borders_never_get_longer():
    mesh = icosphere(3)
    graph = face_graph(mesh, clean_surface(mesh), np.arange(len(mesh.triangles)))
    random = np.random.default_rng(0)
    centres = mesh.vertices[mesh.triangles].mean(axis=1) + random.normal(scale=0.05, size=(len(mesh.triangles), 3))
    labels = (np.abs(centres).argmax(axis=1) + 3 * (centres.sum(axis=1) > 0)).astype(np.int32)

    def length(labels):
        ends = labels[graph.neighbours]
        return graph.length[ends[:, 0] != ends[:, 1]].sum()

    moved = shortened_borders(labels, graph)
    assert length(moved) < 0.9 * length(labels)
    assert set(moved) == set(labels)
