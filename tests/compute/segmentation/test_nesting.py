import itertools

import numpy as np
import pytest

from compute import LevelError, TriangleMesh, analyze
from examples import humanoid
from tests.compute.test_analysis import n_pieces
from tests.shapes import icosphere, star


@pytest.fixture(scope="module")
def person():
    character = humanoid(4000)
    return analyze(type(star())(character.vertices, character.triangles), order=2)


def test_beyond_the_default_level_parts_are_only_divided(person):
    """Every part of a finer level lies in one part of the coarser one."""
    levels = range(person.hierarchy.default_level, person.hierarchy.n_levels)
    labels = [person.segment(level=level, mode="nested").labels for level in levels]
    for coarse, fine in itertools.pairwise(labels):
        for part in set(fine.tolist()):
            assert len(set(coarse[fine == part].tolist())) == 1


def test_an_arm_keeps_its_number_when_its_fingers_appear(person):
    coarse = person.segment(mode="nested")
    fine = person.segment(level=person.hierarchy.n_levels - 1, mode="nested")
    assert set(coarse.parts.id.tolist()) <= set(fine.parts.id.tolist())
    assert fine.n_parts > coarse.n_parts + 8


def test_the_parent_of_a_finger_is_a_part_that_it_touches(person):
    fine = person.segment(level=person.hierarchy.n_levels - 1, mode="nested")
    pairs = fine.labels[person.mesh.edges.neighbours]
    touching = {tuple(pair) for pair in pairs.tolist()} | {tuple(pair[::-1]) for pair in pairs.tolist()}
    for part, parent in zip(fine.parts.id.tolist(), fine.parts.parent.tolist(), strict=True):
        assert part == 0 or (part, parent) in touching


def test_nested_parts_are_connected(person):
    for level in range(person.hierarchy.n_levels):
        labels = person.segment(level=level, mode="nested").labels
        for part in set(labels.tolist()) - {0}:
            assert n_pieces(person.mesh, labels == part) == 1


def test_a_blunt_end_is_no_nested_part():
    """A capsule's ends are hemispheres: features of the field, but nothing stands out."""
    capsule = icosphere(4).vertices * [1, 1, 1] + np.sign(icosphere(4).vertices[:, 2:]) * [0, 0, 0.2]
    analysis = analyze(type(star())(capsule, icosphere(4).triangles))
    level = analysis.hierarchy.n_levels - 1
    assert analysis.segment(level=level, mode="features").n_parts >= 3
    assert analysis.segment(level=level, mode="nested").n_parts == 1


@pytest.mark.parametrize(("height", "sharpness", "is_part"), [(0.3, 90, True), (0.4, 30, False)])
def test_a_feature_of_a_finer_level_is_a_nested_part_if_it_stands_out_more_than_a_hemisphere(
    height, sharpness, is_part
):
    """Two arms and a thorn or a hill: too small for the default level, and both would be too blunt there."""
    ball = icosphere(4)
    toward = ball.vertices @ np.transpose([(1, 0, 0), (-0.98, 0, 0.2), (0, 1, 0.1)])
    radius = 1 + np.exp([25, 25, sharpness] * (toward - 1)) @ [2.5, 2.5, height]
    analysis = analyze(TriangleMesh(ball.vertices * radius[:, None], ball.triangles))
    default = analysis.hierarchy.default_level
    coarse, fine = (analysis.segment(level=level, mode="nested") for level in (default, default + 1))
    tip = np.argmax(ball.vertices[ball.triangles].mean(axis=1) @ [0, 1, 0.1])
    size = [int((labels == labels[tip]).sum()) for labels in (coarse.labels, fine.labels)]
    assert (size[1] < 0.1 * size[0]) == is_part


def test_refuses_an_unknown_mode():
    with pytest.raises(LevelError, match='"features" or "nested"'):
        analyze(star()).segment(mode="all")


def arm_of(person):
    """Return the label of the part that reaches furthest to the left."""
    segmentation = person.segment(mode="features")
    tips = person.net.positions[segmentation.parts.extremum[1:]]
    return int(segmentation.parts.id[1:][np.argmax(tips[:, 0])])


def test_an_arm_on_its_own_has_five_fingers(person):
    arm = arm_of(person)
    coarse, fine = person.segment(mode="features"), person.segment(within=arm, mode="features")
    assert (fine.parts.parent == arm).sum() == 5
    np.testing.assert_array_equal(fine.labels[coarse.labels != arm], coarse.labels[coarse.labels != arm])
    tips = person.net.positions[fine.parts.extremum[fine.parts.parent == arm]]
    assert (tips[:, 0] > 0.9 * person.mesh.vertices[:, 0].max() - 0.1).all()


def test_the_table_of_a_part_that_was_divided_fits_the_labels(person):
    fine = person.segment(within=arm_of(person), mode="features")
    area = np.bincount(fine.labels, person.mesh.areas)
    np.testing.assert_allclose(fine.parts.area, area[fine.parts.id])
    np.testing.assert_array_equal(fine.parts.n_triangles, np.bincount(fine.labels)[fine.parts.id])


@pytest.mark.parametrize("part", [77, -1])
def test_refuses_to_divide_a_part_that_is_not_there(person, part):
    with pytest.raises(LevelError, match="0 faces"):
        person.segment(within=part)


def test_no_belt_is_left_between_chest_and_hips(person):
    """Chest and hips both end in a neck at the waist; the larger one is body."""
    nested = person.segment(joints=False)
    assert nested.parts.area[0] > 0.05 * nested.parts.area.sum()
    assert nested.n_parts == 7
