"""The file that is open: its meshes, and what its reader knows of them that Blender has no place for."""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...operators.blender.known_values import mesh_of
from ...tasks.refusals import Refusal
from .off import FaceLines
from .repairs import WHOLE_FILE, Repairs


@dataclass(frozen=True, eq=False)
class OpenFile:
    """The meshes of the file that is open.

    Attributes
    ----------
    objects : list of Object
        One for each mesh, by name.
    repairs : Repairs
        What was mended when they were read.
    face_lines : FaceLines, optional
        Of an .off file.
    """

    objects: list[bpy.types.Object]
    repairs: Repairs
    face_lines: FaceLines | None = None

    def repairs_of(self, obj: bpy.types.Object) -> list[str]:
        """Return what was mended of the mesh of an object, and of the file as a whole."""
        return [*self.repairs.get(WHOLE_FILE, ()), *self.repairs.get(mesh_of(obj).name, ())]


def open_file(repairs: Repairs, face_lines: FaceLines | None = None) -> OpenFile:
    """Return the file that was just read, with its mesh objects that have faces, each mesh once."""
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH" and mesh_of(obj).library is None]
    shapes_of_bones = _shapes_of_bones()
    objects = {mesh_of(obj): obj for obj in reversed(meshes) if obj not in shapes_of_bones}
    if not objects:
        raise Refusal(
            "there is no mesh in this file but the shapes of bones." if meshes else "there is no mesh in this file."
        )
    # Guides have no faces; where there are others, nobody wants these divided.
    divisible = [obj for obj in objects.values() if mesh_of(obj).polygons]
    return OpenFile(sorted(divisible or objects.values(), key=lambda obj: obj.name), repairs, face_lines)


def _shapes_of_bones() -> set[bpy.types.Object]:
    """Return the objects that bones are only shown as."""
    bones = [bone for obj in bpy.data.objects if obj.pose for bone in obj.pose.bones]
    return {bone.custom_shape for bone in bones if bone.custom_shape is not None}
