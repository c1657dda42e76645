"""Characters made of loose parts: which shells belong together, and where they are bridged."""

import numpy as np
import pytest

from compute import EngineError, MeshError, RegistrationError, TriangleMesh, analyze, match, skeleton, zero_level
from compute.surface.bridging import bridge_shells, large_shells
from compute.surface.cleaning import bridged_surface, clean_surface
from tests.shapes import icosphere, joined, rectangle, star, torus


def ball(centre, radius, n_subdivisions=3):
    sphere = icosphere(n_subdivisions)
    return TriangleMesh(radius * sphere.vertices + centre, sphere.triangles)


def chain(gap):
    """Return a large ball and a row of three smaller ones beside it, with a gap between neighbours."""
    row = ball([0, 0, 0], 1.0)
    for k in range(3):
        row = joined(row, ball([1.3 + gap + k * (0.6 + gap), 0, 0], 0.3))
    return row


def reached(surface):
    return np.unique(surface.input_triangle)


def test_a_single_shell_is_left_as_it_is():
    single = icosphere(2)
    np.testing.assert_array_equal(bridged_surface(single).mesh.triangles, clean_surface(single).mesh.triangles)


def test_shells_that_nearly_touch_become_one_component():
    surface = bridged_surface(chain(gap=0.02))
    assert surface.n_joined == surface.n_components == 4
    assert surface.mesh.component_of_triangle.max() == 0
    assert len(reached(surface)) == 4 * 1280


def test_shells_out_of_reach_follow_what_is_next_to_them():
    surface = bridged_surface(chain(gap=0.5))
    assert surface.n_joined == 1
    assert len(reached(surface)) == 1280


def test_what_lies_on_a_shell_is_not_analyzed():
    """A skin just outside, as clothes are."""
    assert bridged_surface(joined(ball([0, 0, 0], 1.0), ball([0, 0, 0], 1.03))).n_joined == 1


def test_details_are_not_analyzed():
    assert bridged_surface(joined(ball([0, 0, 0], 1.0), ball([1.05, 0, 0], 0.05, 1))).n_joined == 1


def test_a_bridge_stands_on_a_neighbouring_shell():
    mesh = chain(gap=0.02)
    surface = bridged_surface(mesh)
    is_bridge = np.arange(len(surface.mesh.triangles)) >= len(reached(surface))
    piers = mesh.triangles[surface.input_triangle[is_bridge]]
    shared = (surface.mesh.triangles[is_bridge][:, :, None] == piers[:, None, :]).any(axis=2).sum(axis=1)
    assert is_bridge.any()
    assert (shared == 2).all()


def test_limbs_that_are_loose_are_parts_all_the_same():
    segmentation = analyze(chain(gap=0.02), order=1).segment(mode="nested")
    of_shell = segmentation.labels.reshape(4, -1)
    assert of_shell[0, 0] != of_shell[3, 0]
    assert (of_shell[3] == of_shell[3, 0]).mean() > 0.9


@pytest.mark.parametrize("scale", [1e-4, 1e4])
def test_the_unit_of_length_does_not_matter(scale):
    mesh = chain(gap=0.02)
    scaled = bridged_surface(TriangleMesh(scale * mesh.vertices, mesh.triangles))
    np.testing.assert_array_equal(scaled.mesh.triangles, bridged_surface(mesh).mesh.triangles)


def test_the_largest_shell_can_be_analyzed_alone():
    assert analyze(chain(gap=0.02), order=1, shells="largest").surface.n_joined == 1
    with pytest.raises(MeshError, match="bridged"):
        analyze(chain(gap=0.02), shells="all")


def placed(mesh, scale, centre):
    return TriangleMesh(scale * mesh.vertices + centre, mesh.triangles)


CHARACTERS = star(n_arms=5, n_subdivisions=3), placed(star(n_arms=3, n_subdivisions=3), 0.7, [6, 0, 0])
EYES = placed(icosphere(1), 0.08, [6, 0, 0.75]), placed(icosphere(1), 0.08, [2.4, 0, 0.15])
TOGETHER = joined(*CHARACTERS, *EYES)
ENDS = np.cumsum([len(mesh.triangles) for mesh in (*CHARACTERS, *EYES)])[:-1]


def divide_alike(first, second):
    """Whether two arrays of labels are the same but for the numbers."""
    pairs = np.unique(np.stack([first, second]), axis=1).shape[1]
    return pairs == len(np.unique(first)) == len(np.unique(second))


@pytest.mark.parametrize("mode", ["features", "nested"])
@pytest.mark.parametrize(("field", "order"), [("diffusion", 3), (1, 1), (4, 2), (4, 3)])
def test_each_shell_is_divided_as_if_it_were_alone(field, order, mode):
    analysis = analyze(TOGETHER, field=field, order=order, shells="separate")
    of_shells = np.split(analysis.segment(mode=mode).labels, ENDS)
    for character, labels in zip(CHARACTERS, of_shells, strict=False):
        assert divide_alike(analyze(character, field=field, order=order).segment(mode=mode).labels, labels)
    assert not set(of_shells[0].tolist()) & set(of_shells[1].tolist())


def test_values_of_ones_own_count_on_each_shell_by_themselves():
    field = np.concatenate([k * np.cos(4 * mesh.vertices[:, 0]) for k, mesh in enumerate((*CHARACTERS, *EYES), 3)])
    of_shells = np.split(analyze(TOGETHER, field=field, shells="separate").segment().labels, ENDS)
    for character, labels in zip(CHARACTERS, of_shells, strict=False):
        own = np.cos(4 * character.vertices[:, 0])
        assert divide_alike(analyze(character, field=own).segment().labels, labels)


def test_eyes_take_the_part_of_what_they_lie_on():
    analysis = analyze(TOGETHER, order=1, shells="separate")
    first, _, eye_on_body, eye_on_arm = np.split(analysis.segment(mode="features").labels, ENDS)
    body = analysis.segment(level=0).labels[ENDS[0]]
    assert set(eye_on_body.tolist()) == {body}
    centres = np.linalg.norm(CHARACTERS[0].vertices[CHARACTERS[0].triangles].mean(axis=1) - [2.4, 0, 0.15], axis=1)
    assert set(eye_on_arm.tolist()) == {first[centres.argmin()]} != {0}
    assert analysis.surface.n_joined == 2


def test_at_level_zero_each_shell_is_one_part():
    segmentation = analyze(TOGETHER, order=1, shells="separate").segment(level=0)
    assert [len(set(labels.tolist())) for labels in np.split(segmentation.labels, ENDS)[:2]] == [1, 1]
    assert segmentation.n_parts == 2


@pytest.mark.parametrize("mode", ["features", "nested"])
def test_arms_grow_out_of_the_body_of_their_own_shell(mode):
    analysis = analyze(TOGETHER, order=1, shells="separate")
    parts = analysis.segment(mode=mode).parts
    body = int(analysis.segment(level=0).labels[ENDS[0]])
    own = set(np.split(analysis.segment(mode=mode).labels, ENDS)[1].tolist()) - {body}
    assert own
    assert {int(parts.parent[parts.id == part][0]) for part in own} == {body}


def test_levels_add_the_most_persistent_feature_of_any_shell():
    analysis = analyze(TOGETHER, order=1, shells="separate")
    n_parts = [analysis.segment(level=level, mode="features").n_parts for level in range(analysis.hierarchy.n_levels)]
    assert n_parts == sorted(n_parts)
    alone = [analyze(character, order=1).hierarchy for character in CHARACTERS]
    relative = [one.persistence[one.persistence > 1e-4 * one.value_range] / one.value_range for one in alone]
    found = analysis.hierarchy.persistence[-(analysis.hierarchy.n_levels - 1) :]
    np.testing.assert_allclose(found, np.sort(np.concatenate(relative)), rtol=1e-9)


def test_the_index_sum_of_shells_is_the_sum_of_their_euler_characteristics():
    both = joined(torus(), placed(icosphere(2), 2.0, [9, 0, 0]))
    analysis = analyze(both, field=2, order=2, shells="separate")
    assert analysis.complex.euler_characteristic == 0 + 2
    assert analysis.complex.reeb_graph.n_components == 2


def test_a_single_shell_is_analyzed_as_ever():
    alone, separate = (analyze(CHARACTERS[0], order=1, shells=shells) for shells in ("bridged", "separate"))
    np.testing.assert_array_equal(alone.field.values, separate.field.values)
    np.testing.assert_array_equal(alone.segment().labels, separate.segment().labels)


def test_a_round_shell_and_one_of_few_faces_are_one_part_each():
    ground = placed(rectangle(1, 1), 30.0, [0, 0, -9])
    mesh = joined(ground, CHARACTERS[0], placed(icosphere(3), 1.0, [0, 9, 0]))
    labels = analyze(mesh, shells="separate").segment(threshold=0, mode="features").labels
    plane, character, ball = np.split(labels, np.cumsum([2, len(CHARACTERS[0].triangles)]))
    assert (len(set(plane.tolist())), len(set(ball.tolist()))) == (1, 1)
    assert divide_alike(character, analyze(CHARACTERS[0]).segment(threshold=0, mode="features").labels)


def test_a_shell_without_a_boundary_to_hold_is_not_divided_and_told():
    analysis = analyze(
        joined(rectangle(8, 4), placed(CHARACTERS[1], 0.2, [9, 0, 0])), boundary="dirichlet", shells="separate"
    )
    assert any("closed" in warning for warning in analysis.warnings)
    with pytest.raises(EngineError, match="closed"):
        analyze(joined(*CHARACTERS), boundary="dirichlet", shells="separate")


def test_what_needs_one_shape_refuses_shells_that_were_analyzed_apart():
    analysis = analyze(joined(*CHARACTERS), order=1, shells="separate")
    with pytest.raises(RegistrationError, match="by itself"):
        match(analysis, analysis)
    with pytest.raises(RegistrationError, match="by itself"):
        skeleton(analysis)


def test_the_zero_level_is_that_of_the_largest_shell():
    first, second = np.split(zero_level(analyze(joined(*CHARACTERS), order=1, shells="separate")).labels, ENDS[:1])
    assert divide_alike(first, zero_level(analyze(CHARACTERS[0], order=1)).labels)
    assert len(set(second.tolist())) == 1


def test_a_bridge_has_one_corner_on_one_shell_and_two_on_the_next():
    mesh = chain(gap=0.02)
    bridges = bridge_shells(mesh)
    shell = np.repeat(np.arange(4), len(mesh.vertices) // 4)[bridges.triangles]
    assert bridges.is_joined.all()
    assert len(shell) > 0
    assert (shell[:, 1] == shell[:, 2]).all()
    assert (np.abs(shell[:, 0] - shell[:, 1]) == 1).all()


def test_shells_of_little_area_are_details():
    mesh = joined(joined(icosphere(2), ball([3, 0, 0], 0.05, 1)), ball([5, 0, 0], 0.07, 1))
    assert large_shells(mesh).tolist() == [True, True, False]
