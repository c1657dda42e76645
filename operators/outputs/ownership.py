"""The attributes that are ours, known again where the list of them was damaged; others in their place are refused."""

import bpy

from ..mesh_data.mesh_arrays import OwnAttribute, mark_lost, refuse_foreign
from ..mesh_state.schema import BRANCHES
from ..mesh_state.state import is_analyzed


def mend(mesh: bpy.types.Mesh, attributes: tuple[OwnAttribute, ...]) -> None:
    """Mark those of our attributes on an analyzed mesh again that are not marked any more.

    Nothing of the user's can be among them: an analysis is refused where something else has the name of one, and an
    output is not chosen before.
    """
    if is_analyzed(mesh) or BRANCHES[0].is_on(mesh):
        mark_lost(mesh, attributes)


def claim(mesh: bpy.types.Mesh, attributes: tuple[OwnAttribute, ...]) -> None:
    """Mend the marks of attributes, and raise a Refusal if something of the user's stands where one belongs."""
    mend(mesh, attributes)
    refuse_foreign(mesh, attributes)
