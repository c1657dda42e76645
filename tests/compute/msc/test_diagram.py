"""The separated persistence diagram and what is read from it."""

import gudhi
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import seed as drawn_by
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from compute.errors import FieldError
from compute.msc.diagram import PersistenceDiagram, persistence_curve, size_function
from compute.msc.diagram_distance import bottleneck_distance, diagram_distance
from tests.compute.msc.surfaces import closed_surface, diagram_of, noise, waves, with_holes
from tests.selection import draws
from tests.shapes import icosphere

SURFACE = icosphere(1)


def random_points(rng: np.random.Generator, n: int) -> np.ndarray:
    """Return points on both sides of the diagonal, some of them on a grid, so that distances coincide."""
    points = rng.normal(size=(n, 2))
    return np.round(points, 1) if n % 2 else points


def gudhis_bottleneck(first: np.ndarray, second: np.ndarray) -> float:
    """GUDHI wants points above the diagonal, so it is asked twice."""
    minima = [points[points[:, 0] < points[:, 1]] for points in (first, second)]
    maxima = [points[points[:, 0] > points[:, 1]][:, ::-1] for points in (first, second)]
    return max(gudhi.bottleneck_distance(*minima), gudhi.bottleneck_distance(*maxima))


def test_negated_field_has_the_mirrored_diagram():
    rng = np.random.default_rng(0)
    for mesh in (closed_surface(0), closed_surface(2), with_holes(closed_surface(1), rng)):
        values = noise(mesh, rng)
        mirrored, expected = diagram_of(mesh, values).negated(), diagram_of(mesh, -values)
        for name in ("points", "components", "loops"):
            ours, theirs = getattr(mirrored, name), getattr(expected, name)
            np.testing.assert_array_equal(ours[np.lexsort(ours.T)], theirs[np.lexsort(theirs.T)])


@pytest.mark.parametrize("seed", range(60))
def test_bottleneck_distance_is_gudhis(seed):
    rng = np.random.default_rng(seed)
    first, second = random_points(rng, seed), random_points(rng, rng.integers(0, 60))
    assert bottleneck_distance(first, second) == pytest.approx(gudhis_bottleneck(first, second), rel=1e-12, abs=1e-15)


def test_bottleneck_distance_of_smooth_and_noisy_fields_is_gudhis():
    mesh = closed_surface(1)
    for seed in range(10):
        rng = np.random.default_rng(seed)
        field = waves(mesh, rng)
        first, second = diagram_of(mesh, field), diagram_of(mesh, field + 0.1 * noise(mesh, rng))
        expected = gudhis_bottleneck(first.points, second.points)
        assert diagram_distance(first, second, "bottleneck") == pytest.approx(expected, rel=1e-12)


def test_hausdorff_distance_is_the_worst_of_the_nearest():
    for seed in range(30):
        rng = np.random.default_rng(seed)
        first, second = random_points(rng, 5 + seed), random_points(rng, 20)
        between = np.abs(first[:, None] - second).max(axis=2)
        there = np.minimum(between.min(axis=1), np.abs(np.diff(first)).ravel() / 2).max()
        back = np.minimum(between.min(axis=0), np.abs(np.diff(second)).ravel() / 2).max()
        none = np.empty((0, 2))
        diagrams = [PersistenceDiagram(points, none, none) for points in (first, second)]
        assert diagram_distance(*diagrams) == pytest.approx(max(there, back), rel=1e-14)


values_on_the_surface = st.lists(st.floats(-1, 1).map(lambda x: round(x, 3)), min_size=42, max_size=42).map(np.array)


@pytest.mark.parametrize("draw", draws(4))
def test_diagrams_are_stable(draw):
    """The distance of two diagrams is at most the largest difference of the fields (Cohen-Steiner et al. 2007)."""

    @drawn_by(draw)
    @settings(max_examples=50, deadline=None, database=None, suppress_health_check=list(HealthCheck))
    @given(values_on_the_surface, values_on_the_surface, st.floats(0, 2))
    def check(values, change, size):
        changed = values + size * change
        first, second = diagram_of(SURFACE, values), diagram_of(SURFACE, changed)
        largest = np.abs(values - changed).max() * (1 + 1e-12)
        assert diagram_distance(first, second, "hausdorff") <= largest
        assert diagram_distance(first, second, "bottleneck") <= largest

    check()


@pytest.mark.parametrize("seed", [1, 2])
def test_size_function_counts_components_that_reach_down(seed):
    mesh = closed_surface(1)
    rng = np.random.default_rng(seed)
    values = noise(mesh, rng)
    diagram = diagram_of(mesh, values)
    sides, n = mesh.edges.vertices, len(values)
    for _ in range(50):
        x, y = np.sort(rng.normal(size=2))
        low = values[sides].max(axis=1) <= y
        graph = coo_array((np.ones(low.sum(), dtype=bool), tuple(sides[low].T)), shape=(n, n))
        component = connected_components(graph, directed=False)[1]
        assert size_function(diagram, x, y) == len(np.unique(component[values <= x]))


def test_persistence_curve_counts_the_pairs_above_a_threshold():
    mesh = closed_surface(0)
    diagram = diagram_of(mesh, noise(mesh, np.random.default_rng(0)))
    threshold, count = persistence_curve(diagram)
    assert (count == (diagram.persistence[:, None] >= threshold).sum(axis=0)).all()


def test_unknown_metric_is_refused():
    diagram = diagram_of(SURFACE, SURFACE.vertices[:, 0])
    with pytest.raises(FieldError, match="wasserstein"):
        diagram_distance(diagram, diagram, "wasserstein")


def test_the_bottleneck_of_denormal_points_is_found():
    tiny = np.array([[0.0, 5e-324], [0.0, 2e-323]])
    assert bottleneck_distance(tiny, np.zeros((0, 2))) <= 2e-323
