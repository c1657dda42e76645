"""Output: the parts as face sets, which sculpt mode shows, hides and masks."""

import bpy

from ..mesh_data.mesh_arrays import OwnAttribute, remove_own_attributes, write_attribute
from .division import Division
from .output import Output

FACE_SET = OwnAttribute(".sculpt_face_set", "INT", "FACE")


def write(mesh: bpy.types.Mesh, division: Division) -> None:
    """Write the face sets; they count from 1, so the body is 1."""
    write_attribute(mesh, FACE_SET, division.labels + 1)


def remove(mesh: bpy.types.Mesh) -> None:
    """Take the face sets back."""
    remove_own_attributes(mesh, [FACE_SET.name])


OUTPUT = Output(
    "FACE_SETS",
    "Face Sets",
    "Show, hide and mask parts in sculpt mode",
    (FACE_SET,),
    write,
    remove,
)
