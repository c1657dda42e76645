"""The Morse-Smale complex against the counts that theory gives, at every level."""

import numpy as np
import pytest

from compute.msc.critical_points import Kind
from compute.msc.integral_lines import ascent_of, exits_of, steepest_exits, trace
from compute.msc.links import links_of
from compute.msc.morse_smale import MorseSmaleComplex
from compute.msc.ranked_net import ranked_net
from compute.surface.mesh import TriangleMesh
from tests.compute.msc.surfaces import closed_surface, noise, topology, waves
from tests.shapes import icosphere, rectangle, torus


def complex_of(mesh: TriangleMesh, values: np.ndarray) -> MorseSmaleComplex:
    return MorseSmaleComplex(topology(mesh, values))


def harmonic_sphere() -> MorseSmaleComplex:
    """The product xyz has 4 maxima, 4 minima and 6 saddles on the sphere."""
    sphere = icosphere(4)
    turned = sphere.vertices @ np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    return complex_of(sphere, turned.prod(axis=1))


def wavy_torus() -> MorseSmaleComplex:
    mesh = torus(96, 48)
    return complex_of(mesh, waves(mesh, np.random.default_rng(4)))


def test_line_on_a_plane_runs_straight_along_the_gradient():
    mesh = rectangle(16, 8)
    slope = np.array([1.0, 0.37, 0.0])
    values, links = mesh.vertices @ slope, links_of(mesh.triangles, len(mesh.vertices))
    ascent = ascent_of(ranked_net(links, values), mesh.vertices, values)
    exits = exits_of(ascent)
    start = steepest_exits(exits, exits.vertex, len(values))[0]
    (line,), (end,) = trace(ascent, exits, np.array([start]))
    inside = line[(line[:, 0] < 2) & (line[:, 1] < 1)]
    assert len(inside) > 16
    np.testing.assert_allclose(np.cross(inside, slope), 0, atol=1e-12)
    assert end == len(values) - 1


def test_lines_on_a_sphere_follow_the_meridians():
    mesh = icosphere(5)
    axis = np.array([0.3, 0.2, 1.0]) / np.linalg.norm([0.3, 0.2, 1.0])
    values, links = mesh.vertices @ axis, links_of(mesh.triangles, len(mesh.vertices))
    ascent = ascent_of(ranked_net(links, values), mesh.vertices, values)
    exits = exits_of(ascent)
    starts = steepest_exits(exits, exits.vertex, len(values))[np.flatnonzero(np.abs(values) < 0.02)]
    lines, end = trace(ascent, exits, starts)
    assert (end == values.argmax()).all()
    for line in lines:
        away = line - np.outer(line @ axis, axis)
        radius = np.linalg.norm(away, axis=1)
        direction = (away / np.maximum(radius, 1e-9)[:, None])[radius > 0.2]
        assert (direction @ direction[0] > np.cos(0.1)).all()


@pytest.mark.parametrize("build", [harmonic_sphere, wavy_torus])
def test_each_simple_saddle_sends_two_lines_up_and_two_down(build):
    found = build()
    saddles = found.critical_points.unfolded().vertex[found.critical_points.unfolded().kind == Kind.SADDLE]
    lines = found.separatrices
    for rises in (True, False):
        np.testing.assert_array_equal(np.sort(lines.saddle[lines.rises == rises]), np.sort(np.repeat(saddles, 2)))


@pytest.mark.parametrize("build", [harmonic_sphere, wavy_torus])
def test_lines_run_monotonely_from_saddle_to_extremum(build):
    found = build()
    lines = found.separatrices
    for saddle, extremum, rises, line in zip(lines.saddle, lines.extremum, lines.rises, lines.lines, strict=True):
        np.testing.assert_array_equal(line[[0, -1]], found.topology.positions[[saddle, extremum]])
        assert (found.topology.values[extremum] > found.topology.values[saddle]) == rises


@pytest.mark.parametrize("build", [harmonic_sphere, wavy_torus])
def test_cells_are_twice_the_saddles_at_every_level(build):
    """A cell has four sides and a simple saddle four lines, each with a cell on both sides."""
    full = build()
    for n_pairs in range(len(full.pairing), -1, -1):
        found = full.simplified(n_pairs)
        points = found.critical_points
        n_saddles = points.multiplicity[points.kind == Kind.SADDLE].sum()
        assert len(found.cells) == max(2 * n_saddles, 1)
        assert len(found.separatrices) == 4 * n_saddles


@pytest.mark.parametrize("build", [harmonic_sphere, wavy_torus])
def test_each_cell_lies_between_one_minimum_and_one_maximum(build):
    """Of the lines along its rim, all that rise end at its maximum and all others at its minimum."""
    found = build()
    sides = {tuple(sorted(edge)): row for row, edge in enumerate(found.topology.links.edges.vertices.tolist())}
    cells_at = [[] for _ in sides]
    for triangle, row in enumerate(found.topology.links.edges.of_triangle.tolist()):
        for edge in row:
            cells_at[edge].append(found.cells.of_triangle[triangle])
    lines = found.separatrices
    for path, rises, extremum in zip(lines.paths, lines.rises, lines.extremum, strict=True):
        beside = cells_at[sides[tuple(sorted(path[:2].tolist()))]]
        ends = found.cells.maximum if rises else found.cells.minimum
        assert set(ends[beside]) == {extremum}


@pytest.mark.parametrize(("genus", "field"), [(0, noise), (2, noise), (1, waves)])
def test_cancelling_keeps_the_euler_characteristic_and_only_survivors(genus, field):
    mesh = closed_surface(genus)
    full = complex_of(mesh, field(mesh, np.random.default_rng(genus)))
    for n_pairs in (0, 1, 3, 7, len(full.pairing)):
        found = full.simplified(n_pairs)
        points = found.critical_points
        assert found.euler_characteristic == 2 - 2 * genus
        left = points.vertex[points.kind != Kind.SADDLE]
        assert set(found.separatrices.extremum) <= set(left)
        assert len(left) == min(n_pairs, len(full.pairing)) + 2


def test_cancelling_is_reversible_at_any_level():
    full = wavy_torus()
    again = full.simplified(1).simplified(len(full.pairing))
    np.testing.assert_array_equal(again.separatrices.saddle, full.separatrices.saddle)
    for ours, theirs in zip(again.separatrices.lines, full.separatrices.lines, strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_extended_lines_pass_through_the_saddles_they_went_through():
    full = harmonic_sphere()
    found = full.simplified(2).separatrices
    lines = dict(zip(full.separatrices.saddle.tolist(), full.separatrices.lines, strict=True))
    long = [line for line, path in zip(found.lines, found.paths, strict=True) if len(set(path) & set(lines)) > 1]
    assert long
    for line in long:
        assert np.linalg.norm(np.diff(line, axis=0), axis=1).max() < 0.2


def test_monkey_saddle_sends_three_lines_up_and_three_down():
    mesh = rectangle(40, 40, 2, 2)
    x, y, _ = (mesh.vertices - [1, 1, 0]).T
    found = complex_of(mesh, x**3 - 3 * x * y**2)
    centre = 20 * 41 + 20
    lines = found.separatrices
    assert [(lines.saddle[lines.rises == rises] == centre).sum() for rises in (True, False)] == [3, 3]
