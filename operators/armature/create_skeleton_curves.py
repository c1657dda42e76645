"""Operator: the skeleton of the active mesh as a curve object, for rendering and scripts."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.mesh_shape import Stretch
from ...tasks.skeleton_laying import NamedSkeleton
from ..blender.known_values import mesh_of, present
from ..mesh_data.world_shape import as_transform, world_matrix
from ..messages.sentences import Messages
from .skeleton_request import SkeletonRequest, part_names

# On the curve: the part that each of its splines lies in, by name.
SPLINE_PARTS = "eigenparts_spline_parts"
# Thickness of the curves as a fraction of the limbs'.
THICKNESS = 0.2


class EIGENPARTS_OT_create_skeleton_curves(SkeletonRequest, bpy.types.Operator):
    """Draw the skeleton of the active mesh as a curve object, one spline for each row of bones in a part"""

    bl_idname = "eigenparts.create_skeleton_curves"
    bl_label = "Create Skeleton Curves"
    bl_options = {"REGISTER", "UNDO"}

    def build(self, context: bpy.types.Context, obj: bpy.types.Object, laid: NamedSkeleton) -> Messages:
        skeleton = laid.skeleton
        rows = rows_of_bones(skeleton.parent, skeleton.part, skeleton.loops)
        names = part_names(mesh_of(obj), skeleton)
        curve = add_curve(obj, [(skeleton.joints[row], skeleton.radius[row]) for row in rows], laid.stretch)
        present(curve.data)[SPLINE_PARTS] = [names[int(skeleton.part[row[1]])] for row in rows]
        present(context.view_layer).objects.active = curve
        curve.select_set(True)
        return Messages((f"{len(rows)} splines in {curve.name}.",))


def rows_of_bones(parent: NDArray[np.int64], part: NDArray[np.int64], loops: NDArray[np.int64]) -> list[list[int]]:
    """Return the joints of each row of bones that follow each other in one part; opened loops are closed again."""
    rows: dict[int, list[int]] = {}
    n_children = np.bincount(parent[1:], minlength=len(parent))
    for joint in range(1, len(parent)):
        before = int(parent[joint])
        goes_on = before in rows and n_children[before] == 1 and part[before] == part[joint]
        row = rows.pop(before) if goes_on else [before]
        rows[joint] = [*row, joint]
    closed = [[*rows.pop(end, [end]), start] for end, start in loops.tolist() if end != start]
    return [*rows.values(), *closed]


def add_curve(
    obj: bpy.types.Object, lines: list[tuple[NDArray[np.float64], NDArray[np.float64]]], stretch: Stretch
) -> bpy.types.Object:
    """Add a curve object where an object is, with a polyline for each row of (n, 3) points and (n,) radii.

    Parameters
    ----------
    stretch : Stretch
        From the mesh of the object to the shape in which the points lie.
    """
    data = bpy.data.curves.new(f"{obj.name} skeleton", "CURVE")
    data.dimensions, data.bevel_depth = "3D", THICKNESS
    for points, radii in lines:
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.points.foreach_set("co", np.column_stack([points, np.ones(len(points))]).ravel())
        spline.points.foreach_set("radius", radii)
    curve = bpy.data.objects.new(data.name, data)
    for collection in obj.users_collection:
        collection.objects.link(curve)
    # Scaled as the object, the curve would be flattened with it.
    curve.matrix_world = world_matrix(obj) @ as_transform(stretch.inverse)
    return curve


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_create_skeleton_curves,))
