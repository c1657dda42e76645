"""All that a division can leave on a mesh beside the face map: each can be chosen, and follows the level."""

from types import ModuleType

import bpy
import numpy as np

from ..mesh_data.mesh_arrays import OwnAttribute
from ..mesh_state import part_table
from ..mesh_state.state import STATE
from . import corner_colours, face_sets, field_values, material_slots, vertex_groups, vertex_map
from .division import Division

# Name, what the user reads of it, and the module that writes and removes it.
OUTPUTS: dict[str, tuple[str, str, ModuleType]] = {
    "VERTEX_ATTRIBUTE": ("Vertex Attribute", 'Attribute "part_vertex": the part of most faces around', vertex_map),
    "CORNER_COLORS": ("Colors", 'Color attribute "part_color", crisp at the borders', corner_colours),
    "FACE_SETS": ("Face Sets", "Show, hide and mask parts in sculpt mode", face_sets),
    "VERTEX_GROUPS": ("Vertex Groups", "A vertex group for each part, of its name", vertex_groups),
    "MATERIALS": ("Materials", "A material slot for each part; your own assignment comes back", material_slots),
    "FIELD": ("Field", 'Attribute "eigenparts_field": the numbers whose hills are the parts', field_values),
}
DEFAULT = ("VERTEX_ATTRIBUTE", "CORNER_COLORS")
COLOURED = ("CORNER_COLORS", "MATERIALS")
# Those that are more than an attribute.
COMPOUND = ("VERTEX_GROUPS", "MATERIALS")
# In the state: the chosen ones, one a line, and the width over which vertex groups are softened.
CHOSEN, SOFTNESS = "outputs", "softness"


def chosen(mesh: bpy.types.Mesh) -> tuple[str, ...]:
    """Return which outputs the mesh is to have."""
    state = mesh.get(STATE)
    names = state.get(CHOSEN) if hasattr(state, "to_dict") else None
    if not isinstance(names, str):
        return DEFAULT
    return tuple(name for name in OUTPUTS if name in names.splitlines())


def softness(mesh: bpy.types.Mesh) -> float:
    """Return the width over which vertex groups are softened, in the mesh's unit."""
    state = mesh.get(STATE)
    width = state.get(SOFTNESS) if hasattr(state, "to_dict") else None
    return max(0.0, float(width)) if isinstance(width, int | float) else 0.0


def choose(mesh: bpy.types.Mesh, names: set[str], width: float) -> None:
    """Store which outputs an analyzed mesh is to have, and take back those it is not to have any more."""
    for name in set(chosen(mesh)) - names:
        OUTPUTS[name][2].remove(mesh)
    mesh[STATE][CHOSEN] = "\n".join(name for name in OUTPUTS if name in names)
    mesh[STATE][SOFTNESS] = width


def division_of(mesh: bpy.types.Mesh, labels: np.ndarray) -> Division:
    """Return what outputs need to know of the parts (F,) of the faces."""
    present = np.flatnonzero(np.bincount(labels))
    names = {part: part_table.name_of(mesh, part) for part in present.tolist()}
    return Division(labels, names, part_table.colours(mesh, int(labels.max(initial=0)) + 1), softness(mesh))


def write(mesh: bpy.types.Mesh, labels: np.ndarray, kinds: tuple[str, ...] = tuple(OUTPUTS)) -> None:
    """Write those of the chosen outputs that are of some kinds."""
    division = division_of(mesh, labels)
    for name in chosen(mesh):
        if name in kinds:
            OUTPUTS[name][2].write(mesh, division)


def remove(mesh: bpy.types.Mesh) -> None:
    """Take back all outputs."""
    for _, _, output in OUTPUTS.values():
        output.remove(mesh)


def own_attributes(names: tuple[str, ...]) -> tuple[OwnAttribute, ...]:
    """Return the attributes that some outputs write."""
    return tuple(attribute for name in names for attribute in OUTPUTS[name][2].ATTRIBUTES)
