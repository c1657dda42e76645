"""Limbs along straight chains."""

from dataclasses import replace

import numpy as np
import pytest

from compute.skeletons.limbs import Ends, lay_limb, trace_limb, with_equal_joints
from tests.compute.skeletons.shapes import chain, slices_of

N = 20
# A limb along z: a hub of part 0 below, slices from z = 1 to 20, those above 10 in part 2, the tip at 21.
LIMB = chain(0, 1, *range(N))
CENTRES = np.column_stack([np.zeros((N, 2)), np.arange(1, N + 1)])[None].astype(float)
ENDS = Ends(0, -1, np.array([[[0, 0, 0], [0, 0, 21.0]]]), (0, -1))


def slices(part=1):
    return slices_of([N], girth=2 * np.pi * 0.5, part=part)


def test_a_straight_limb_comes_free_of_its_hub_and_ends_in_the_tip():
    trace = trace_limb(LIMB, ENDS, slices(), CENTRES, 1)
    limb = lay_limb(trace, slices())
    assert trace.has_carrier
    assert limb.part.tolist() == [0, 1]
    np.testing.assert_allclose(limb.joints[-1], [0, 0, 21], atol=1e-9)
    # The joint lies three quarters of a radius, or most of the carrier, deeper than the first ring.
    assert 0 < limb.joints[0, 2] < 1
    np.testing.assert_allclose(limb.radius, 0.5)


def test_a_border_of_parts_is_a_joint():
    two = slices(np.repeat([1, 2], N // 2))
    limb = lay_limb(trace_limb(LIMB, ENDS, two, CENTRES, 1), two)
    assert limb.part.tolist() == [0, 1, 2]
    assert limb.joints[1, 2] == pytest.approx(11, abs=0.45)
    np.testing.assert_array_equal(limb.bone_of_slice[1:10], 1)
    np.testing.assert_array_equal(limb.bone_of_slice[11:], 2)


@pytest.mark.parametrize("n_pieces", [2, 3])
def test_long_bones_are_divided(n_pieces):
    limb = lay_limb(trace_limb(LIMB, ENDS, slices(), CENTRES, n_pieces), slices())
    lengths = np.diff(limb.joints[:, 2])
    assert len(lengths) == n_pieces
    np.testing.assert_allclose(lengths[1:], 20 / n_pieces, atol=1)


def test_mirrored_limbs_get_the_joints_of_the_one_that_has_more():
    other = chain(0, 2, *range(N, 2 * N))
    both = slices_of([N, N], girth=np.pi, part=np.repeat([1, 2], N))
    centres = np.concatenate([CENTRES, CENTRES], axis=1)
    plain, divided = (trace_limb(one, ENDS, both, centres, k) for one, k in ((LIMB, 1), (other, 3)))
    alone = with_equal_joints([plain, divided], both, np.array([0, 1, 2]))
    equal = with_equal_joints([plain, divided], both, np.array([0, 2, 1]))
    assert [len(trace.joints) for trace in alone] == [3, 5]
    np.testing.assert_array_equal(equal[0].joints, divided.joints)
    np.testing.assert_array_equal(equal[1].joints, divided.joints)


def test_parts_that_are_settled_are_kept():
    trace = replace(trace_limb(LIMB, ENDS, slices(), CENTRES, 1), parts=np.array([5, 6]))
    assert lay_limb(trace, slices()).part.tolist() == [5, 6]
