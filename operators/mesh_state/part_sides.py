"""Which parts of a mesh are left and right, kept with its analysis so that registered meshes can be told alike."""

import bpy

from . import bone_layout
from .state import STATE

# In the state: for each part that has a side, the part both sides are called after, and +1 for left, -1 for right.
SIDES = "part_sides"


def remember(mesh: bpy.types.Mesh, pairing: dict[int, tuple[int, int]]) -> None:
    """Keep the sides of the parts that a mesh shows."""
    mesh[STATE][SIDES] = {str(part): list(pair) for part, pair in pairing.items()}


def of_reference(mesh: bpy.types.Mesh) -> dict[int, tuple[int, int]]:
    """Return the sides of the mesh that this one is registered to; empty if it is not, or they are not known."""
    reference = bone_layout.reference_of(mesh)
    return {} if reference is None else read(reference.data)


def read(mesh: bpy.types.Mesh) -> dict[int, tuple[int, int]]:
    """Return the sides that a mesh remembers, as far as they can be understood."""
    state = mesh.get(STATE)
    group = state.get(SIDES) if hasattr(state, "to_dict") else None
    if not hasattr(group, "to_dict"):
        return {}
    rows = {part: group[part] for part in group if part.isdecimal()}
    whole = {part: tuple(row) for part, row in rows.items() if getattr(row, "typecode", None) == "i" and len(row) == 2}
    return {int(part): row for part, row in whole.items() if row[1] in (-1, 1)}
