"""What users do before they press an operator, so that most are pressed where there is something to do."""

from random import Random

import bpy

from tests.blender.pressed import press
from tests.blender.random_steps import cast, user

# Faces and parts that are too few to do much with.
FEW_FACES, FEW_PARTS = 50, 2
TO_OTHERS = {"register_selected", "transfer"}
OF_REGISTERED = {"flip_function", "next_alternative"}
OF_CORRECTED = {"remove_correction", "clear_corrections"}


def make_ready(name: str, chance: Random) -> None:
    """Make an object active that an operator takes, with other objects, parts or corrections that it wants."""
    user.leave_mode()
    user.change_selection(chance)
    candidates = [obj for obj in user.meshes() if len(obj.data.polygons) > FEW_FACES and _is_ready(obj, name)]
    if candidates:
        bpy.context.view_layer.objects.active = chance.choice(candidates)
        bpy.context.object.select_set(True)
    else:
        _prepare(name, chance)
    if name in TO_OTHERS and chance.random() < 0.7:
        _add_twin()
        bpy.context.object.vertex_groups.new(name="grip").add([0, 1, 2], 0.5, "REPLACE")
    if chance.random() < 0.3 or name == "paint_part":
        user.select_some_faces(bpy.context.object.data, chance.random(), chance)


def _is_ready(obj: bpy.types.Object, name: str) -> bool:
    """Return whether an operator takes an object, and has something to do there."""
    state = obj.data.get("eigenparts_state") or {}
    if name in OF_REGISTERED:
        return "registration" in state
    if name in OF_CORRECTED and not len(obj.data.eigenparts.correction_rows):
        return False
    if len(obj.data.eigenparts.rows) <= FEW_PARTS and (state or "part" in _properties(name)):
        return False
    bpy.context.view_layer.objects.active = obj
    return name in TO_OTHERS or getattr(bpy.ops.eigenparts, name).poll()


def _properties(name: str) -> list[str]:
    return getattr(bpy.ops.eigenparts, name).get_rna_type().properties.keys()


def _prepare(name: str, chance: Random) -> None:
    """Add an object that an operator has something to do on."""
    cast.add_shape(chance.choice(["body", "star"]), chance)
    press("analyze", order="1")
    if name in OF_REGISTERED:
        twin = _add_twin()
        press("register_selected", order="1")
        cast.select(twin)
    if name in OF_CORRECTED:
        bpy.context.object.data.eigenparts.active_row = 1
        press("move_border", offset=0.02)


def _add_twin() -> bpy.types.Object:
    """Add a copy of the active object beside it, selected as the only other one."""
    active = bpy.context.object
    twin = active.copy()
    twin.data = active.data.copy()
    bpy.context.collection.objects.link(twin)
    cast.select(active)
    twin.select_set(True)
    return twin
