"""The index of the lower link on complexes of every kind."""

import numpy as np
import pytest

from compute.msc.critical_points import CriticalPoints, Kind, critical_points
from compute.msc.links import links_of
from compute.msc.ranked_net import ranked_net
from compute.surface.mesh import TriangleMesh
from tests.compute.msc import surfaces
from tests.shapes import icosphere, joined, rectangle, torus

COMPLEXES = {
    "sphere": (lambda: icosphere(2), 2),
    "torus": (torus, 0),
    "genus 3": (lambda: surfaces.closed_surface(3), -4),
    "two spheres": (lambda: joined(icosphere(1), icosphere(2)), 4),
    "disk": (lambda: rectangle(6, 4), 1),
    "annulus": (surfaces.annulus, 0),
    "two cones sharing a vertex": (surfaces.cones_sharing_their_tip, 1),
    "three sheets on an edge": (surfaces.three_sheets_on_an_edge, 1),
    "sphere with a wall": (surfaces.sphere_with_a_wall, 3),
    "projective plane": (surfaces.projective_plane, 1),
    "sieve": (lambda: surfaces.with_holes(icosphere(2), np.random.default_rng(1), 0.4), None),
}


def points_of(mesh: TriangleMesh, values: np.ndarray) -> CriticalPoints:
    return critical_points(values, ranked_net(links_of(mesh.triangles, len(mesh.vertices)), values))


@pytest.mark.parametrize("name", COMPLEXES)
def test_index_sum_is_the_euler_characteristic_for_f_and_minus_f(name):
    build, expected = COMPLEXES[name]
    mesh = build()
    counted = len(np.unique(mesh.triangles)) - len(mesh.edges.vertices) + len(mesh.triangles)
    assert expected in (None, counted)
    for seed in range(20):
        values = surfaces.noise(mesh, np.random.default_rng(seed))
        assert points_of(mesh, values).euler_characteristic == counted
        assert points_of(mesh, -values).euler_characteristic == counted


def test_standing_torus_has_a_minimum_two_saddles_and_a_maximum():
    mesh = torus(32, 16)
    points = points_of(mesh, mesh.vertices[:, 0] + 0.01 * mesh.vertices[:, 2])
    assert sorted(points.kind) == [Kind.MINIMUM, Kind.SADDLE, Kind.SADDLE, Kind.MAXIMUM]
    assert points.multiplicity.tolist() == [1, 1, 1, 1]


def test_monkey_saddle_is_a_saddle_of_multiplicity_two():
    """Around the tip of a cone of 12 triangles, cos 3 phi rises and falls three times."""
    angle = np.arange(12) * np.pi / 6
    rim = np.arange(1, 13)
    mesh = TriangleMesh(
        np.vstack([[0, 0, 0], np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)]),
        np.stack([0 * rim, rim, np.roll(rim, -1)], axis=1),
    )
    points = points_of(mesh, np.append(0, np.cos(3 * angle + 0.1)))
    tip = points.vertex == 0
    assert (points.kind[tip].tolist(), points.multiplicity[tip].tolist()) == ([Kind.SADDLE], [2])
    simple = points.unfolded()
    assert (simple.vertex == 0).sum() == 2
    assert (simple.multiplicity == 1).all()
    assert simple.euler_characteristic == points.euler_characteristic


def test_maximum_on_a_side_of_a_square_is_not_critical_for_sublevel_sets():
    """The cosine of pi x has its largest values on a side, where nothing changes but for the last vertex."""
    mesh = rectangle(8, 8)
    points = points_of(mesh, np.cos(np.pi * mesh.vertices[:, 0] / 2) + 1e-3 * mesh.vertices[:, 1])
    assert points.kind.tolist() == [Kind.MINIMUM]


@pytest.mark.parametrize("n_values", [1, 2, 3])
def test_plateaus_have_the_same_index_sum(n_values):
    mesh = surfaces.closed_surface(2)
    for seed in range(20):
        steps = np.random.default_rng(seed).integers(0, n_values, len(mesh.vertices)).astype(float)
        assert points_of(mesh, steps).euler_characteristic == -2


def test_only_closed_fans_are_plain():
    mesh = surfaces.cones_sharing_their_tip()
    assert not links_of(mesh.triangles, len(mesh.vertices)).is_plain.any()
    assert links_of(icosphere(1).triangles, 50).is_plain.sum() == 42


def test_a_flipped_triangle_changes_no_critical_point():
    mesh = icosphere(2)
    values = surfaces.noise(mesh, np.random.default_rng(0))
    flipped = np.where(np.arange(len(mesh.triangles))[:, None] % 3 == 0, mesh.triangles[:, ::-1], mesh.triangles)
    before, after = points_of(mesh, values), points_of(TriangleMesh(mesh.vertices, flipped), values)
    np.testing.assert_array_equal(before.vertex, after.vertex)
    np.testing.assert_array_equal(before.multiplicity, after.multiplicity)
