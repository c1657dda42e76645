"""Trees of joints, and the vertices that belong to their bones."""

from dataclasses import replace

import numpy as np
import pytest

from compute import analyze
from compute.skeletons.hubs import Hub
from compute.skeletons.joint_tree import JointTree, join_limbs, without_short_bones
from compute.skeletons.limb_plan import LimbPlan, PlannedLimb, plan_limbs
from compute.skeletons.limbs import Ends, Limb
from compute.skeletons.ownership import bones_of_vertices
from compute.skeletons.sliced_shape import slice_shape
from tests.compute.skeletons.shapes import chain, spindle


def limb(start, end, slices, *joints) -> Limb:
    n = len(joints)
    places, bones = np.array([[0.0, 0, z] for z in joints]), np.zeros(len(slices), dtype=np.int64)
    return Limb(start, end, places, np.ones(n), np.full(n, 1 + start), np.array(slices, dtype=np.int64), bones)


def plan(*limbs, closes_loop=()) -> LimbPlan:
    hubs = [Hub(frozenset([k]), np.zeros((1, 3)), 1.0) for k in range(2)]
    sides = frozenset(), frozenset()
    ends = [Ends(one.start, one.end, np.zeros((1, 2, 3)), (0, 0)) for one in limbs]
    planned = [PlannedLimb(chain(end.start, end.end), end, sides, k in closes_loop) for k, end in enumerate(ends)]
    return LimbPlan(hubs=hubs, root=0, root_part=0, limbs=planned, centres=np.zeros((1, 0, 3)))


def test_limbs_begin_where_those_before_them_end():
    limbs = [limb(0, 1, [0, 1], 1, 2), limb(1, -1, [3], 3, 4), limb(0, -1, [2], -1)]
    tree = join_limbs(plan(*limbs), limbs, 5)
    assert tree.parent.tolist() == [-1, 0, 1, 2, 3, 0]
    assert tree.part.tolist() == [0, 1, 1, 2, 2, 1]
    assert tree.bone_of_slice.tolist() == [1, 1, 5, 3, -1]
    assert tree.is_tip.tolist() == [False, False, False, False, True, True]


def test_a_limb_that_closes_a_loop_is_open_at_its_end():
    limbs = [limb(0, 1, [], 1), limb(0, 1, [], 2, 3)]
    tree = join_limbs(plan(*limbs, closes_loop={1}), limbs, 0)
    assert tree.loops.tolist() == [[3, 1]]
    assert tree.is_tip.tolist() == [False, True, False, False]


def test_bones_without_length_are_left_out():
    limbs = [limb(0, -1, [0, 1], 1, 1 + 1e-6, 2), limb(0, -1, [2], 1e-6, -1)]
    tree = join_limbs(plan(*limbs), limbs, 3)
    tree = replace(tree, bone_of_slice=np.array([2, 3, 4]))
    short = without_short_bones(tree)
    np.testing.assert_allclose(short.places[:, 2], [0, 1, 2, -1])
    assert short.parent.tolist() == [-1, 0, 1, 0]
    # The bone that ends in the root's double is none.
    assert short.bone_of_slice.tolist() == [1, 2, -1]


@pytest.fixture(scope="module")
def shape():
    analysis = analyze(spindle(49, 24), field=1, order=1)
    upper = (analysis.mesh.vertices[analysis.mesh.triangles].mean(axis=1)[:, 2] > 0).astype(np.int32)
    return slice_shape(analysis, upper, None, [])


def test_a_spindle_is_planned_from_its_middle_to_both_tips(shape):
    planned = plan_limbs(shape, None)
    assert len(planned.hubs) == 1
    np.testing.assert_allclose(planned.hubs[0].places[0], 0, atol=0.15)
    assert {limb.sides[1] for limb in planned.limbs} == {frozenset([0]), frozenset([1])}


def test_in_the_body_each_vertex_belongs_to_a_bone_of_its_part_however_near_others_are(shape):
    tree = JointTree(
        places=np.array([[0, 0, 0], [0, 0, 2.9], [0, 0, -2.9]]),
        parent=np.array([-1, 0, 0]),
        part=np.array([9, 0, 1]),
        radius=np.ones(3),
        loops=np.zeros((0, 2), dtype=np.int64),
        bone_of_slice=np.full(shape.slices.count, -1),
    )
    owner, z = bones_of_vertices(shape.analysis, shape.slices, tree), shape.analysis.mesh.vertices[:, 2]
    clear = np.abs(z) > 0.2
    np.testing.assert_array_equal(owner[clear], np.where(z[clear] > 0, 2, 1))


def test_on_limbs_the_level_set_decides(shape):
    tree = JointTree(
        places=np.array([[0, 0, 0], [0, 0, 2.9], [0, 0, -2.9]]),
        parent=np.array([-1, 0, 0]),
        part=np.array([9, 1, 0]),
        radius=np.ones(3),
        loops=np.zeros((0, 2), dtype=np.int64),
        bone_of_slice=np.full(shape.slices.count, 2),
    )
    assert set(bones_of_vertices(shape.analysis, shape.slices, tree).tolist()) == {2}
