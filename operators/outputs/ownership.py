"""The list of the attributes that are ours, mended where it was damaged: what stands where only we write is ours."""

import bpy

from ..mesh_data.mesh_arrays import OwnAttribute, mark_own, own_names
from ..mesh_state import state
from . import output_registry
from .division import PART


def mend(mesh: bpy.types.Mesh) -> None:
    """Mark our attributes again if some of an analyzed mesh are not marked any more.

    Nothing of the user's can be among them: an analysis is refused where something else has the name of one, and an
    output is not chosen before.
    """
    marked = own_names(mesh)
    lost = [own.name for own in _expected(mesh) if own.name not in marked and own.is_on(mesh)]
    if lost and (state.is_analyzed(mesh) or state.BRANCHES[0].is_on(mesh)):
        mark_own(mesh, lost)


def _expected(mesh: bpy.types.Mesh) -> tuple[OwnAttribute, ...]:
    return (PART, *state.ATTRIBUTES, *output_registry.own_attributes(output_registry.chosen(mesh)))
