import numpy as np
import pytest

from compute import LevelError
from compute.msc.links import links_of
from compute.msc.morse_smale import FieldTopology
from compute.segmentation.hierarchy.levels import build_hierarchy
from tests.compute.segmentation.reference import parts_of_level
from tests.shapes import icosphere, rectangle, torus


def smooth_and_noisy_field(mesh, seed):
    """Return a few waves and some noise, different for every seed."""
    random = np.random.default_rng(seed)
    waves = np.sin(mesh.vertices @ random.normal(size=(3, 4)) * 2 + random.uniform(0, 6, 4)) @ random.normal(size=4)
    return waves + random.choice([0, 0.1, 1]) * random.normal(size=len(waves))


def topology_of(mesh, values):
    return FieldTopology(links_of(mesh.triangles, len(mesh.vertices)), mesh.vertices, values)


def parts_of_hierarchy(hierarchy, arcs, level):
    found = {}
    for tree, arc in zip(hierarchy.trees, arcs, strict=True):
        part = tree.spread(np.where(tree.is_feature(level), tree.part, 0))[arc]
        tips = {int(p): int(e) for p, e in zip(tree.part, tree.extremum, strict=True)}
        found |= {
            (tree.is_of_maxima, tips[p]): set(np.flatnonzero(part == p).tolist()) for p in set(part.tolist()) - {0}
        }
    return found


@pytest.mark.parametrize("shape", [icosphere(2), torus(12, 8), rectangle(8, 6)], ids=["sphere", "torus", "rectangle"])
@pytest.mark.parametrize("minima_are_features", [False, True])
@pytest.mark.parametrize("seed", range(8))
def test_parts_of_every_level_are_those_of_the_definition(shape, minima_are_features, seed):
    values = smooth_and_noisy_field(shape, seed)
    hierarchy, arcs = build_hierarchy(topology_of(shape, values), minima_are_features=minima_are_features)
    for level in range(min(hierarchy.n_levels, 12)):
        expected = parts_of_level(shape.triangles, values, level, minima_are_features)
        found = parts_of_hierarchy(hierarchy, arcs, level)
        assert found == expected


@pytest.mark.parametrize("seed", range(6))
def test_essential_saddles_end_parts_at_every_level(seed):
    shape = torus(12, 8)
    values = smooth_and_noisy_field(shape, seed)
    topology = topology_of(shape, values)
    essential = set(topology.essential.loops.ravel().tolist())
    assert len(essential) == 2
    hierarchy, arcs = build_hierarchy(topology, minima_are_features=True, ends_at_handles=True)
    for level in range(min(hierarchy.n_levels, 12)):
        expected = parts_of_level(shape.triangles, values, level, True, essential)
        assert parts_of_hierarchy(hierarchy, arcs, level) == expected


def test_a_constant_field_has_one_level():
    mesh = icosphere(2)
    hierarchy, _ = build_hierarchy(topology_of(mesh, np.ones(162)), minima_are_features=True)
    assert hierarchy.n_levels == 1
    assert hierarchy.default_level == 0


def test_pairs_are_ordered_by_rising_persistence():
    mesh = icosphere(2)
    values = smooth_and_noisy_field(mesh, 3)
    hierarchy, _ = build_hierarchy(topology_of(mesh, values), minima_are_features=True)
    np.testing.assert_array_equal(hierarchy.persistence, np.abs(np.diff(values[hierarchy.pairs], axis=1))[:, 0])
    assert (np.diff(hierarchy.persistence) >= 0).all()


def test_a_part_keeps_its_number_at_every_level():
    mesh = icosphere(3)
    hierarchy, _ = build_hierarchy(topology_of(mesh, smooth_and_noisy_field(mesh, 5)), minima_are_features=False)
    tree = hierarchy.trees[0]
    for level in range(hierarchy.n_levels):
        roots = tree.is_feature(level)
        assert tree.part[roots].max(initial=0) <= level + 1
        assert len(set(tree.part[roots])) == roots.sum()


def test_a_threshold_says_which_pairs_stay():
    mesh = icosphere(3)
    hierarchy, _ = build_hierarchy(topology_of(mesh, smooth_and_noisy_field(mesh, 1)), minima_are_features=False)
    assert hierarchy.level_of_threshold(0) == hierarchy.n_levels - 1
    assert hierarchy.level_of_threshold(2) == 0
    middle = hierarchy.level_of_threshold(0.3)
    assert (hierarchy.persistence >= 0.3 * hierarchy.value_range).sum() == middle


@pytest.mark.parametrize("level", [-1, 1.5, 10_000])
def test_refuses_a_level_that_does_not_exist(level):
    mesh = icosphere(2)
    hierarchy, _ = build_hierarchy(topology_of(mesh, smooth_and_noisy_field(mesh, 0)), minima_are_features=True)
    with pytest.raises(LevelError, match=f"Level {level} does not exist"):
        hierarchy.checked_level(level)


@pytest.mark.parametrize("threshold", [-0.1, np.nan])
def test_refuses_a_threshold_that_is_no_fraction(threshold):
    mesh = icosphere(2)
    hierarchy, _ = build_hierarchy(topology_of(mesh, np.ones(162)), minima_are_features=True)
    with pytest.raises(LevelError, match="fraction"):
        hierarchy.level_of_threshold(threshold)
