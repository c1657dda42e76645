"""Meshes that are wholes only with their modifiers: what is read of them is not what is seen."""

import bpy
import numpy as np

from ..blender.known_values import mesh_of
from .mesh_arrays import read_positions

# Types of modifiers that add a part of the shape, such as the other half of a body, or take one away.
ADD_OR_TAKE = frozenset(("ARRAY", "BOOLEAN", "BUILD", "EXPLODE", "MASK", "MIRROR", "SCREW", "SKIN"))
# Nodes may do anything, and often only smooth the normals; they add if the whole is so much longer along an axis.
MAY_ADD, LONGER = "NODES", 1.2

UNFINISHED = (
    'The modifier "{}" of {} adds to the mesh or takes from it, and the mesh is matched without it; apply the modifier'
    " first."
)
UNFINISHED_IN_MANY_WAYS = (
    'The modifiers "{}" of {} add to the mesh or take from it, and the mesh is matched without them; apply the'
    " modifiers first."
)


def modifiers_that_add(obj: bpy.types.Object) -> tuple[str, ...]:
    """Return the names of the modifiers without which the shape of an object is not the one that is seen."""
    shown = [modifier for modifier in obj.modifiers if modifier.show_viewport]
    known = tuple(modifier.name for modifier in shown if modifier.type in ADD_OR_TAKE)
    nodes = tuple(modifier.name for modifier in shown if modifier.type == MAY_ADD)
    return known or (nodes if nodes and _is_extended(obj) else ())


def unfinished(name: str, modifiers: tuple[str, ...]) -> str:
    """Return what is said of the modifiers of an object that cannot be matched well; empty if there are none."""
    sentence = UNFINISHED if len(modifiers) == 1 else UNFINISHED_IN_MANY_WAYS
    return sentence.format('", "'.join(modifiers), name) if modifiers else ""


def _is_extended(obj: bpy.types.Object) -> bool:
    """Whether modifiers make an object notably longer along an axis."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    whole, own = (np.ptp(read_positions(mesh_of(one)), axis=0) for one in (evaluated, obj))
    return bool((whole > LONGER * own).any())
