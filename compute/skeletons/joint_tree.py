"""The tree of joints: limbs put together, joints inside the mesh, bones of some length."""

from dataclasses import dataclass, replace

import numpy as np

from ..surface.mesh import Bools, Floats, Ints
from .interior import Interior
from .limb_plan import LimbPlan
from .limbs import Limb

# Bones shorter than this fraction of the skeleton are none.
SHORTEST_BONE = 2e-3


@dataclass(frozen=True, eq=False)
class JointTree:
    """Joints joined to a tree by bones; J joints, each but the root with the bone that ends in it.

    Attributes
    ----------
    places : (J, 3) float64
    parent : (J,) int64
        The joint at which the bone begins, of smaller index; -1 for the root, which comes first.
    part : (J,) int64
        The part each bone lies in; that of the hub for the root.
    radius : (J,) float64
        Of the limb around each joint.
    loops : (L, 2) int64
        Pairs of joints at one place, where a handle was opened to make the graph a tree.
    bone_of_slice : (S,) int64
        The bone, by the joint it ends in, that each slice lies around; -1 for slices that no limb runs through.
    """

    places: Floats
    parent: Ints
    part: Ints
    radius: Floats
    loops: Ints
    bone_of_slice: Ints

    @property
    def is_tip(self) -> Bools:
        """(J,) whether no bone begins at a joint, and it is not where a handle was opened."""
        is_tip = np.ones(len(self.parent), dtype=bool)
        is_tip[self.parent[1:]] = False
        is_tip[self.loops[:, 0]] = False
        return is_tip


def join_limbs(plan: LimbPlan, limbs: list[Limb], n_slices: int) -> JointTree:
    """Return the tree of the joints of all planned limbs, in their order."""
    joint_of_hub, n_joints = {plan.root: 0}, 1
    parent, loops, bone_of_slice = [np.array([-1])], [], np.full(n_slices, -1)
    for limb, planned in zip(limbs, plan.limbs, strict=True):
        numbers = n_joints + np.arange(len(limb.joints))
        parent.append(np.append(joint_of_hub[limb.start], numbers[:-1]))
        bone_of_slice[limb.slices] = numbers[limb.bone_of_slice]
        if planned.closes_loop:
            loops.append((int(numbers[-1]), joint_of_hub[limb.end]))
        elif limb.end >= 0:
            joint_of_hub[limb.end] = int(numbers[-1])
        n_joints += len(numbers)
    root = plan.hubs[plan.root]
    return JointTree(
        places=np.concatenate([root.places[:1], *(limb.joints for limb in limbs)]),
        parent=np.concatenate(parent),
        part=np.concatenate([np.array([plan.root_part]), *(limb.part for limb in limbs)]),
        radius=np.concatenate([np.array([root.radius]), *(limb.radius for limb in limbs)]),
        loops=np.array(loops, dtype=np.int64).reshape(-1, 2),
        bone_of_slice=bone_of_slice,
    )


def pulled_inside(tree: JointTree, interior: Interior) -> JointTree:
    """Return a tree with its joints in the middle of the flesh; tips that lie inside stay under the skin."""
    strays = np.flatnonzero(~tree.is_tip | ~interior.holds(tree.places))
    places = tree.places.copy()
    places[strays] = interior.pulled_inside(places[strays], tree.radius[strays])
    return replace(tree, places=places)


def without_short_bones(tree: JointTree) -> JointTree:
    """Return a tree without the bones that have hardly any length; the joint before stands for the one they end in."""
    kept, number = _long_bones(tree)
    parent = number[tree.parent[kept]]
    parent[0] = -1
    bone_of_slice = np.where(tree.bone_of_slice < 0, -1, number[tree.bone_of_slice])
    # No bone ends in the root.
    bone_of_slice[bone_of_slice == 0] = -1
    return JointTree(
        places=tree.places[kept],
        parent=parent,
        part=tree.part[kept],
        radius=tree.radius[kept],
        loops=number[tree.loops],
        bone_of_slice=bone_of_slice,
    )


def _long_bones(tree: JointTree) -> tuple[Ints, Ints]:
    """Return the joints with a bone of some length, and for each joint the new number of the one that stands for it."""
    least = SHORTEST_BONE * np.ptp(tree.places, axis=0).max()
    stands_for = np.arange(len(tree.parent))
    for joint in range(1, len(tree.parent)):
        before = stands_for[tree.parent[joint]]
        if np.linalg.norm(tree.places[joint] - tree.places[before]) < least:
            stands_for[joint] = before
    kept, number = np.unique(stands_for, return_inverse=True)
    return kept, number.reshape(-1)
