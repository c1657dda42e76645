"""All that parts can be written to beside the face map: each can be chosen, and follows the level."""

import bpy

from ..mesh_data.mesh_arrays import OwnAttribute
from ..mesh_state.schema import ATTRIBUTES, SOFTNESS
from ..mesh_state.schema import OUTPUTS as CHOSEN
from ..mesh_state.state import MeshState
from . import corner_colours, face_sets, field_values, material_slots, vertex_groups, vertex_map
from .division import PART, Division
from .output import Output
from .ownership import claim

# In the order of the panel.
OUTPUTS: dict[str, Output] = {
    output.key: output
    for output in (
        vertex_map.OUTPUT,
        corner_colours.OUTPUT,
        face_sets.OUTPUT,
        vertex_groups.OUTPUT,
        material_slots.OUTPUT,
        field_values.OUTPUT,
    )
}
DEFAULT = tuple(key for key, output in OUTPUTS.items() if output.is_default)


def chosen(names: tuple[str, ...] | None) -> tuple[Output, ...]:
    """Return the outputs of some names, the default ones for None."""
    known = DEFAULT if names is None else names
    return tuple(output for key, output in OUTPUTS.items() if key in known)


def packed_choice(names: tuple[str, ...], softness: float) -> dict[str, str | float]:
    """Return what a mesh remembers of the outputs that it is to have."""
    return {CHOSEN: "\n".join(names), SOFTNESS: softness}


def write(mesh: bpy.types.Mesh, division: Division, names: tuple[str, ...] | None) -> None:
    """Write the outputs of some names, the default ones for None."""
    for output in chosen(names):
        output.write(mesh, division)


def write_coloured(mesh: bpy.types.Mesh, division: Division, names: tuple[str, ...] | None) -> None:
    """Write those of the outputs of some names that show colours."""
    write(mesh, division, tuple(output.key for output in chosen(names) if output.shows_colours))


def write_compound(mesh: bpy.types.Mesh, division: Division, names: tuple[str, ...] | None) -> None:
    """Write those of the outputs of some names that are more than attributes."""
    write(mesh, division, tuple(output.key for output in chosen(names) if output.is_compound))


def remove(mesh: bpy.types.Mesh, outputs: tuple[Output, ...] = tuple(OUTPUTS.values())) -> None:
    """Take some outputs back, all if not given."""
    for output in outputs:
        output.remove(mesh)


def attributes_of(outputs: tuple[Output, ...]) -> tuple[OwnAttribute, ...]:
    """Return the attributes that some outputs write."""
    return tuple(attribute for output in outputs for attribute in output.attributes)


def result_attributes(names: tuple[str, ...] | None) -> tuple[OwnAttribute, ...]:
    """Return all attributes of an analyzed mesh that has the outputs of some names."""
    return (PART, *ATTRIBUTES, *attributes_of(chosen(names)))


def refuse_foreign_results(state: MeshState) -> None:
    """Raise a Refusal if something of the user's stands where a result belongs."""
    attributes = result_attributes(state.outputs)
    claim(state.mesh, attributes)
