"""Operator: make an object of each part."""

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..mesh_data.custom_normals import normals_kept
from ..mesh_data.mesh_arrays import remove_own_attributes
from ..mesh_state.schema import ATTRIBUTES
from ..mesh_state.state import forget, is_analyzed_for, read
from ..messages.sentences import tell
from ..messages.user_errors import can_use_active_mesh, refusals_told
from ..outputs.output_registry import result_attributes
from ..outputs.ownership import mend
from ..outputs.part_writer import read_labels
from ..outputs.rollback import nothing_left_behind


class EIGENPARTS_OT_separate(bpy.types.Operator):
    """Make an object of each part; modifiers, parents, vertex groups and shape keys are kept"""

    bl_idname = "eigenparts.separate"
    bl_label = "Separate Parts"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self), nothing_left_behind(context):
            pieces = separate_parts(present(context.object))
            # A script may be about an object that this view layer has not, where nothing can be selected.
            for piece in set(pieces).intersection(present(context.view_layer).objects):
                piece.select_set(True)
            tell(self, "INFO", f"{len(pieces)} objects.")
            return {"FINISHED"}
        return {"CANCELLED"}


def separate_parts(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """Divide an object by its parts and return all that it became, itself first.

    As when Blender separates, the object itself stays with the first part, the body if it has faces, so that whatever
    refers to it still does. The pieces keep the outputs that were chosen, and forget the analysis: it was of the whole.
    """
    mesh, state = mesh_of(obj), read(mesh_of(obj))
    mend(mesh, result_attributes(state.outputs))
    labels = read_labels(mesh)
    parts = np.unique(labels).tolist()
    if len(parts) < 2:
        raise Refusal("The mesh is one part; there is nothing to separate.")
    names = {part: f"{obj.name} {state.parts.name_of(part)}" for part in parts}
    first, *meshes = [_mesh_of_part(mesh, labels == part, names[part]) for part in parts]
    others = [_copy(obj, piece, names[part]) for part, piece in zip(parts[1:], meshes, strict=True)]
    # From here on nothing can fail.
    obj.data = first
    if mesh.users == 0:
        bpy.data.meshes.remove(mesh)
    return [obj, *others]


def _copy(obj: bpy.types.Object, mesh: bpy.types.Mesh, name: str) -> bpy.types.Object:
    copy = present(obj.copy())
    copy.name, copy.data = name, mesh
    for collection in obj.users_collection:
        collection.objects.link(copy)
    return copy


def _mesh_of_part(mesh: bpy.types.Mesh, is_kept: NDArray[np.bool_], name: str) -> bpy.types.Mesh:
    """Return a copy of a mesh with some of its faces only."""
    piece = present(mesh.copy())
    piece.name = name
    _forget_analysis(piece)
    with normals_kept(piece):
        _delete_faces(piece, ~is_kept)
    return piece


def _delete_faces(mesh: bpy.types.Mesh, is_dropped: NDArray[np.bool_]) -> None:
    edited = bmesh.new()
    edited.from_mesh(mesh)
    dropped: list[bmesh.types.BMVert | bmesh.types.BMEdge | bmesh.types.BMFace] = [
        face for face, drops in zip(edited.faces, is_dropped.tolist(), strict=True) if drops
    ]
    bmesh.ops.delete(edited, geom=dropped, context="FACES")
    edited.to_mesh(mesh)
    edited.free()


def _forget_analysis(mesh: bpy.types.Mesh) -> None:
    remove_own_attributes(mesh, [attribute.name for attribute in ATTRIBUTES])
    mesh.property_unset("eigenparts")
    forget(mesh)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_separate,))
