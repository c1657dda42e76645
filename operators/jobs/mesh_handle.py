"""Objects and meshes as jobs find them again: after undo, edits and deletion, which leave no pointer or name valid."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..mesh_data import mesh_arrays

NO_MESH = "The mesh was deleted while it was analyzed."
IN_EDIT_MODE = "The mesh was taken into edit mode while it was analyzed; leave edit mode and analyze it again."
EDITED = "The mesh was edited while it was analyzed; analyze it again."
NO_OBJECT = "An object was deleted meanwhile."
NOT_IN_VIEW = "The object is not in the view layer; it was deleted, excluded or belongs to another scene."


@dataclass(frozen=True)
class MeshHandle:
    """An object and its mesh, to be found again when a job has ended.

    Attributes
    ----------
    object_uid, mesh_uid : int
        Blender's numbers of the two in this session, which survive undo.
    fingerprint : str
        Of the mesh as it was read.
    """

    object_uid: int
    mesh_uid: int
    fingerprint: str

    @classmethod
    def of(cls, obj: bpy.types.Object) -> MeshHandle:
        """Handle of a mesh object as it is now."""
        return cls(obj.session_uid, mesh_of(obj).session_uid, mesh_arrays.fingerprint(mesh_of(obj)))

    def find_mesh(self) -> bpy.types.Mesh:
        """Return the mesh, if it is still as it was.

        Raises
        ------
        Refusal
            If it was deleted, edited or taken into edit mode.
        """
        mesh = next((mesh for mesh in bpy.data.meshes if mesh.session_uid == self.mesh_uid), None)
        if mesh is None:
            raise Refusal(NO_MESH)
        if mesh.is_editmode:
            raise Refusal(IN_EDIT_MODE)
        if mesh_arrays.fingerprint(mesh) != self.fingerprint:
            raise Refusal(EDITED)
        return mesh

    def find_object(self, if_deleted: str = NO_OBJECT) -> bpy.types.Object:
        """Return the object, whatever it is called by now, if its mesh is still as it was.

        Raises
        ------
        Refusal
            If the mesh cannot be used any more, or the object was deleted, which ``if_deleted`` says.
        """
        self.find_mesh()
        obj = next((obj for obj in bpy.data.objects if obj.session_uid == self.object_uid), None)
        if obj is None:
            raise Refusal(if_deleted)
        return obj

    def find_object_in_view(self, context: bpy.types.Context) -> bpy.types.Object:
        """Return an object of the view layer that has the mesh, the active one if it still has it.

        Raises
        ------
        Refusal
            If the mesh cannot be used any more, or no object with it is in the view layer.
        """
        mesh = self.find_mesh()
        users = [obj for obj in present(context.view_layer).objects if obj.data == mesh]
        if not users:
            raise Refusal(NOT_IN_VIEW)
        return context.object if context.object in users else users[0]
