"""Operator: an armature for the parts that the active mesh shows, and the mesh bound to it."""

from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_shape import Stretch
from ...tasks.refusals import Refusal
from ...tasks.skeleton_laying import NamedSkeleton
from ..blender.known_values import mesh_of, present
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data.world_shape import as_transform
from ..mesh_state.palette import srgb_of
from ..mesh_state.state import read
from ..messages.sentences import Messages
from .bone_names import name_bones
from .skeleton_options import ArmatureOptions
from .skeleton_request import SkeletonRequest, part_names

# Length of the root bone in radii of the body around it.
ROOT_LENGTH = 0.6
# A bone steeper than this is rolled by the front, others by the top.
STEEP = 0.9
# The least length of a bone, as a fraction of the skeleton; Blender deletes bones up to a length of 1e-6.
LEAST_LENGTH, SHORTEST_KEPT = 1e-4, 4e-6
# How many steps of a number of 32 bits the ends of a bone lie apart at least.
SEPARATE = 8
UP, FRONT = (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)

ALREADY_BOUND = (
    "The object has an armature already; remove its Armature modifier and the vertex groups of its bones first, "
    "or choose None as weights for an armature beside it."
)
NOT_BOUND = "Blender found no automatic weights for this mesh; undo, and take the weights from the parts."


class EIGENPARTS_OT_create_armature(ArmatureOptions, SkeletonRequest, bpy.types.Operator):
    """Builds an armature for the parts of the active mesh and binds the mesh to it."""

    bl_idname = "eigenparts.create_armature"
    bl_description = (
        "Build an armature for the parts of the active mesh and bind the mesh to it; "
        "other selected meshes with the same faces show where its limbs bend"
    )
    bl_label = "Create Armature"
    bl_options = {"REGISTER", "UNDO"}

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., NamedSkeleton], MeshHandle]:
        if self.weights != "NONE" and any(
            modifier.type == "ARMATURE" for modifier in present(context.object).modifiers
        ):
            raise Refusal(ALREADY_BOUND)
        return super().begin(context)

    def needs_weights(self) -> bool:
        return self.weights == "PARTS"

    def build(self, context: bpy.types.Context, obj: bpy.types.Object, laid: NamedSkeleton) -> Messages:
        skeleton = laid.skeleton
        taken = {group.name for group in obj.vertex_groups}
        names = name_bones(skeleton.parent, skeleton.part, part_names(mesh_of(obj), skeleton), laid.pairing, taken)
        armature = add_armature(context, obj, laid, names)
        infos, is_bound = (f"{len(names)} bones in {armature.name}.",), True
        if self.weights == "PARTS":
            bind(obj, armature, names, laid)
        elif self.weights == "AUTOMATIC":
            bind_automatically(context, obj, armature)
            is_bound = _is_bound(obj, names)
        return Messages(infos, () if is_bound else (NOT_BOUND,))


def add_armature(
    context: bpy.types.Context, obj: bpy.types.Object, laid: NamedSkeleton, names: list[str]
) -> bpy.types.Object:
    """Add the armature of a skeleton where an object is, and make it the active one."""
    data = bpy.data.armatures.new(f"{obj.name} rig")
    armature = bpy.data.objects.new(f"{obj.name} rig", data)
    for collection in obj.users_collection:
        collection.objects.link(armature)
    _place(armature, obj, laid.stretch)
    armature.show_in_front = True
    present(context.view_layer).objects.active = armature
    armature.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    _add_bones(data.edit_bones, laid, names)
    bpy.ops.object.mode_set(mode="OBJECT")
    _colour_bones(data, mesh_of(obj), laid, names)
    return armature


def _place(armature: bpy.types.Object, obj: bpy.types.Object, stretch: Stretch) -> None:
    """Put an armature where an object is, turned and sized as the object; what is stretched has no good bones."""
    armature.parent, armature.parent_type, armature.parent_bone = obj.parent, obj.parent_type, obj.parent_bone
    armature.matrix_parent_inverse, armature.matrix_basis = obj.matrix_parent_inverse, obj.matrix_basis
    if stretch.is_none:
        return
    unstretched = obj.matrix_basis @ as_transform(stretch.inverse)
    if obj.parent is None:
        armature.matrix_basis = unstretched
    else:
        # Location, rotation and scale cannot undo a shear, which the inverse of the parent can.
        armature.matrix_parent_inverse = obj.matrix_parent_inverse @ unstretched
        armature.matrix_basis.identity()


def bind(obj: bpy.types.Object, armature: bpy.types.Object, names: list[str], laid: NamedSkeleton) -> None:
    """Give an object the weights of its bones as vertex groups, and let the armature move it."""
    for name, column in zip(names[1:], present(laid.weights).T[1:], strict=True):
        group = obj.vertex_groups.new(name=name)
        group.add(np.flatnonzero(column == 1).tolist(), 1.0, "REPLACE")
        # Blender takes one weight for any number of vertices, so the few between two bones go one by one.
        for vertex in np.flatnonzero((column > 0) & (column < 1)).tolist():
            group.add([vertex], column[vertex], "REPLACE")
    obj.parent, obj.parent_type, obj.parent_bone = armature, "OBJECT", ""
    obj.matrix_parent_inverse = as_transform(laid.stretch) @ obj.matrix_basis.inverted_safe()
    modifier = obj.modifiers.new("Armature", "ARMATURE")
    assert isinstance(modifier, bpy.types.ArmatureModifier)
    modifier.object = armature
    # What refines the mesh is to refine the posed one; only a mirrored half must become a whole first.
    n_mirrors = next(i for i, other in enumerate(obj.modifiers) if other.type != "MIRROR")
    obj.modifiers.move(len(obj.modifiers) - 1, n_mirrors)


def bind_automatically(context: bpy.types.Context, obj: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Let Blender find the weights."""
    both = [obj, armature]
    with context.temp_override(
        object=armature, active_object=armature, selected_editable_objects=both, selected_objects=both
    ):
        bpy.ops.object.parent_set(type="ARMATURE_AUTO", keep_transform=True)


def _is_bound(obj: bpy.types.Object, names: list[str]) -> bool:
    of_bones = {group.index for group in obj.vertex_groups if group.name in names}
    return any(element.group in of_bones for vertex in mesh_of(obj).vertices for element in vertex.groups)


def _add_bones(edit_bones: bpy.types.ArmatureEditBones, laid: NamedSkeleton, names: list[str]) -> None:
    skeleton = laid.skeleton
    heads, tails = bone_ends(skeleton)
    root = edit_bones.new(names[0])
    root.head, root.tail = heads[0], tails[0]
    root.use_deform = False
    for joint in range(1, len(names)):
        bone = edit_bones.new(names[joint])
        start = int(skeleton.parent[joint])
        bone.head, bone.tail = heads[joint], tails[joint]
        bone.parent = edit_bones[names[start]]
        bone.use_connect = start > 0
        direction = tails[joint] - heads[joint]
        is_steep = abs(direction[2]) > STEEP * np.linalg.norm(direction)
        bone.align_roll(FRONT if is_steep else UP)


def bone_ends(skeleton: "compute.Skeleton") -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return (J, 3) the heads and the tails of the bones, the root's first, none so short that Blender deletes it."""
    joints, up = skeleton.joints, np.array(UP)
    heads, tails = joints[np.maximum(skeleton.parent, 0)], joints.copy()
    tails[0] = joints[0] + ROOT_LENGTH * skeleton.radius[0] * up
    # Far from the origin, numbers of 32 bits lie farther apart than that.
    extent, farthest = np.ptp(joints, axis=0).max(), np.abs(joints).max(initial=0)
    least = max(LEAST_LENGTH * extent, SHORTEST_KEPT, SEPARATE * float(np.spacing(np.float32(farthest))))
    lengths = np.linalg.norm(tails - heads, axis=1)
    # A bone without length has no direction either.
    ways = np.where((lengths > 0)[:, None], tails - heads, up) / np.where(lengths > 0, lengths, 1)[:, None]
    is_short = lengths < least
    tails[is_short] = (heads + least * ways)[is_short]
    return heads, tails


def _colour_bones(armature: bpy.types.Armature, mesh: bpy.types.Mesh, laid: NamedSkeleton, names: list[str]) -> None:
    """Give bones the colours of their parts."""
    linear = read(mesh).parts.colours_of(int(laid.skeleton.part.max()) + 1)[laid.skeleton.part, :3]
    for name, colour in zip(names, srgb_of(linear).tolist(), strict=True):
        shown = present(armature.bones[name].color)
        shown.palette = "CUSTOM"
        shown.custom.normal = colour
        shown.custom.select = shown.custom.active = [(1 + 2 * component) / 3 for component in colour]


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_create_armature,))
