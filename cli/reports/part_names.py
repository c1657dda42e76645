"""Names of parts outside Blender."""

import bpy

from ...operators.mesh_state.state import read


def names_of_parts(mesh: bpy.types.Mesh) -> dict[int, str]:
    """Return the names that the user gave to parts of an analyzed mesh."""
    return read(mesh).parts.names


def name_of_part(label: int, given: dict[int, str]) -> str:
    """Return the user's name, or "body" or "part_3", which every file format keeps as it is."""
    return given.get(label, f"part_{label}" if label else "body")
