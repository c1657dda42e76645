"""Output: the field itself, a decimal number on each vertex."""

import bpy

from ..mesh_data.mesh_arrays import OwnAttribute, remove_own_attributes, write_attribute
from ..mesh_state.stored_analysis import vertex_heights
from .division import Division
from .output import Output

FIELD = OwnAttribute("eigenparts_field", "FLOAT", "POINT")


def write(mesh: bpy.types.Mesh, division: Division) -> None:
    """Write the field that the parts come from."""
    write_attribute(mesh, FIELD, vertex_heights(mesh))


def remove(mesh: bpy.types.Mesh) -> None:
    """Take the output back."""
    remove_own_attributes(mesh, [FIELD.name])


OUTPUT = Output(
    "FIELD",
    "Field",
    'Attribute "eigenparts_field": the numbers whose hills are the parts',
    (FIELD,),
    write,
    remove,
)
