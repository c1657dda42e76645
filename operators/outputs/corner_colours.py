"""Output: the colour of each part on the corners of its faces, shown as the active colours."""

import bpy
import numpy as np

from ..mesh_data.mesh_arrays import OwnAttribute, n_corners_of_polygon, remove_own_attributes, write_attribute
from .division import Division
from .output import Output

# Decimal colours are copied as they are; byte colours are converted one by one, which is thirty times slower.
PART_COLOR = OwnAttribute("part_color", "FLOAT_COLOR", "CORNER", "color")

# The active colour attribute that the user had before ours.
PREVIOUS_COLOR = "eigenparts_previous_color"


def write(mesh: bpy.types.Mesh, division: Division) -> None:
    """Write the colours and make them the active ones."""
    write_attribute(mesh, PART_COLOR, np.repeat(division.colours[division.labels], n_corners_of_polygon(mesh), axis=0))
    active = mesh.color_attributes.active_color_name
    if active != PART_COLOR.name:
        if active:
            mesh[PREVIOUS_COLOR] = active
        mesh.color_attributes.active_color_name = PART_COLOR.name


def remove(mesh: bpy.types.Mesh) -> None:
    """Take the colours back and make the user's earlier ones active again."""
    remove_own_attributes(mesh, [PART_COLOR.name])
    previous = mesh.get(PREVIOUS_COLOR)
    if previous is not None:
        del mesh[PREVIOUS_COLOR]
    if isinstance(previous, str) and previous in mesh.color_attributes:
        mesh.color_attributes.active_color_name = previous
    elif mesh.color_attributes.active_color_name == PART_COLOR.name:
        # Blender 5.2 keeps the name of an attribute that is gone.
        mesh.color_attributes.active_color_name = ""


OUTPUT = Output(
    "CORNER_COLORS",
    "Colors",
    'Color attribute "part_color", crisp at the borders',
    (PART_COLOR,),
    write,
    remove,
    is_default=True,
    shows_colours=True,
)
