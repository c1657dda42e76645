"""Skeletons in the window: an armature made, posed and taken back, and the same as curves."""

import numpy as np
import pytest

from tests.window.conftest import choose, select, unfold

MESH = "bpy.data.objects['humanoid rest']"
POSED = f"[tuple(v.co) for v in {MESH}.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices]"


@pytest.fixture
def rigged(pair):
    """The character with an armature, which is active."""
    choose(pair, "create armature")
    pair.wait_for("bpy.context.object.type == 'ARMATURE'")
    pair.settle()
    return pair


def turn_an_arm(window):
    """Rotate the first bone of the left arm as a user does, by keys, and return the name of its group."""
    window.press("TAB", ctrl=True)
    window.wait_for("bpy.context.mode == 'POSE'")
    window.run(
        "bones = bpy.context.object.data.bones\n"
        "of_arm = [b for b in bones if b.name.endswith('.L') and 'root' not in b.name and b.head_local.z > 1]\n"
        "arm = min(of_arm, key=lambda bone: bone.head_local.x)\n"
        "bones.active = arm"
    )
    window.press("R")
    window.write("50")
    window.press("RET")
    window.settle()
    return window.value("arm.name")


def test_an_armature_is_made_and_a_bone_of_it_turns_what_it_is_bound_to(rigged, show):
    before = np.array(rigged.value(POSED))
    name = turn_an_arm(rigged)
    moved = np.linalg.norm(np.array(rigged.value(POSED)) - before, axis=1)
    assert moved[before[:, 0] > 0.5].min() > 0.1
    assert moved[before[:, 0] < -0.1].max() < 1e-4
    assert name in rigged.value(f"[group.name for group in {MESH}.vertex_groups]")
    rigged.press("TAB", ctrl=True)
    rigged.wait_for("bpy.context.mode == 'OBJECT'")
    select(rigged, "humanoid rest rig", "humanoid rest")
    unfold(rigged, "Parts", "Skeleton")
    show("armature")


def test_undo_takes_the_armature_and_its_groups_back(rigged, humanoid):
    rigged.press("Z", ctrl=True)
    rigged.wait_for("len(bpy.data.armatures) == 0")
    groups = rigged.value(f"[group.name for group in {MESH}.vertex_groups]")
    assert groups == [bone.name for bone in humanoid.bones]
    assert rigged.value(f"len({MESH}.modifiers)") == 0


def test_the_skeleton_can_be_had_as_curves_and_taken_back(pair):
    choose(pair, "create skeleton curves")
    pair.wait_for("bpy.context.object.type == 'CURVE'")
    parts = pair.value(f"[row.title for row in {MESH}.data.eigenparts.rows]")
    drawn = pair.value("list(bpy.context.object.data['eigenparts_spline_parts'])")
    assert len(drawn) == pair.value("len(bpy.context.object.data.splines)") >= 5
    assert set(drawn) <= set(parts)
    pair.press("Z", ctrl=True)
    pair.wait_for("len(bpy.data.curves) == 0")
