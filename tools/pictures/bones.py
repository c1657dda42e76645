"""Bones as objects that can be rendered: kites as Blender draws them, and balls at the joints."""

import bpy
import numpy as np

from eigenparts.compute.surface.mesh import Floats
from eigenparts.operators.blender.known_values import mesh_of, present
from tools.pictures.characters import add_mesh

BONE, JOINT = (0.02, 0.022, 0.026, 1.0), (1.0, 1.0, 1.0, 1.0)
# Half the width of a bone, as a fraction of its length, but not more than this fraction of the armature's extent.
THICKNESS, MOST_THICKNESS = 0.09, 0.014
# Where along the bone it is thickest.
THICKEST = 0.14
# Radius of joints, as a fraction of the armature's extent.
JOINT_RADIUS = 0.006
# Corners of a kite: its head, four around, its tail.
SIDES = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]])


def bone_objects(armature: bpy.types.Object) -> list[bpy.types.Object]:
    """Return objects that look like the bones that deform, and their joints, as they are posed now."""
    present(bpy.context.view_layer).update()
    deforming = [bone for bone in present(armature.pose).bones if bone.bone.use_deform]
    heads, tails = (np.array([getattr(bone, end) for bone in deforming]) for end in ("head", "tail"))
    extent = float(np.ptp(np.concatenate([heads, tails]), axis=0).max())
    kites = np.concatenate([_kite(head, tail, extent) for head, tail in zip(heads, tails, strict=True)])
    faces = (SIDES + 6 * np.arange(len(deforming))[:, None, None]).reshape(-1, 3)
    bones = add_mesh("Bones", kites, faces)
    mesh_of(bones).shade_flat()
    bones.color.foreach_set(BONE)
    joints = _balls(np.unique(np.concatenate([heads, tails]).round(6), axis=0), JOINT_RADIUS * extent)
    joints.color.foreach_set(JOINT)
    for obj in (bones, joints):
        obj.matrix_world = armature.matrix_world
    present(bpy.context.view_layer).update()
    return [bones, joints]


def _kite(head: Floats, tail: Floats, extent: float) -> Floats:
    """Return the six corners of a bone."""
    along = tail - head
    length = float(np.linalg.norm(along))
    across = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    across *= min(THICKNESS * length, MOST_THICKNESS * extent) / np.linalg.norm(across)
    other = np.cross(along / length, across)
    ring = head + THICKEST * along + np.array([across, other, -across, -other])
    return np.vstack([head, ring, tail])


def _balls(places: Floats, radius: float) -> bpy.types.Object:
    """Add a ball at each place, all of them one object."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=radius)
    ball = present(bpy.context.object)
    corners = np.array([vertex.co for vertex in mesh_of(ball).vertices])
    faces = np.array([face.vertices for face in mesh_of(ball).polygons])
    bpy.data.objects.remove(ball)
    offsets = len(corners) * np.arange(len(places))[:, None, None]
    return add_mesh("Joints", (places[:, None] + corners).reshape(-1, 3), (faces + offsets).reshape(-1, 3))
