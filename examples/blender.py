"""Characters as Blender objects: a mesh with vertex groups on an armature that an artist can pose."""

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from .character import Character
from .rig import Bone, Pose, rotation_about, translation


def add_character(character: Character, pose: str = "rest") -> tuple[bpy.types.Object, bpy.types.Object]:
    """Add a character to the current collection, skinned to an armature in a pose.

    Parameters
    ----------
    character : Character
    pose : str
        One of ``character.poses``; further poses with ``apply_pose``.

    Returns
    -------
    mesh, armature : bpy.types.Object
    """
    armature = _add_armature(character)
    mesh = _add_mesh(character, character.vertices, character.name)
    _add_vertex_groups(mesh, character)
    mesh.parent = armature
    modifier = mesh.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    apply_pose(armature, character, pose)
    return mesh, armature


def add_posed_mesh(character: Character, pose: str = "rest") -> bpy.types.Object:
    """Add a character to the current collection as a plain mesh, in a pose, and return it."""
    return _add_mesh(character, character.mesh_in_pose(pose), f"{character.name} {pose}")


def apply_pose(armature: bpy.types.Object, character: Character, pose: str) -> None:
    """Turn the bones of an armature that ``add_character`` made into a pose of the character."""
    for bone in character.bones:
        own = _own_motion(bone, character.poses[pose])
        posed = armature.pose.bones[bone.name]
        at_rest = posed.bone.matrix_local
        posed.matrix_basis = at_rest.inverted() @ own @ at_rest


def _own_motion(bone: Bone, pose: Pose) -> Matrix:
    """Return how a bone moves apart from its parent, in the space of the armature."""
    own = rotation_about(bone.head, pose.angles.get(bone.name, (0.0, 0.0, 0.0)))
    return Matrix(own if bone.parent else translation(pose.shift) @ own)


def _add_mesh(character: Character, vertices: NDArray[np.float64], name: str) -> bpy.types.Object:
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices.tolist(), [], character.quads.tolist())
    data.shade_smooth()
    return _linked(bpy.data.objects.new(name, data))


def _add_vertex_groups(mesh: bpy.types.Object, character: Character) -> None:
    for bone, weights in zip(character.bones, character.weights.T, strict=True):
        group = mesh.vertex_groups.new(name=bone.name)
        # Blender takes one weight for any number of vertices, so this loop is its own.
        for vertex in np.flatnonzero(weights).tolist():
            group.add([vertex], weights[vertex], "REPLACE")


def _add_armature(character: Character) -> bpy.types.Object:
    name = f"{character.name} rig"
    armature = _linked(bpy.data.objects.new(name, bpy.data.armatures.new(name)))
    armature.show_in_front = True
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in character.bones:
        _add_bone(armature.data.edit_bones, bone)
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def _add_bone(edit_bones: bpy.types.ArmatureEditBones, bone: Bone) -> None:
    added = edit_bones.new(bone.name)
    added.head, added.tail = bone.head, bone.tail
    if bone.parent:
        added.parent = edit_bones[bone.parent]
        added.use_connect = (added.head - added.parent.tail).length < 1e-6


def _linked(obj: bpy.types.Object) -> bpy.types.Object:
    bpy.context.collection.objects.link(obj)
    return obj
