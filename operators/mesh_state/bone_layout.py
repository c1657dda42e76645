"""Which bones a mesh was given, kept with its analysis so that registered meshes can be given the same ones."""

from __future__ import annotations

import json
from typing import Any

import bpy

from ... import compute
from . import registration_record
from .state import STATE

# In the state: the bones of the last skeleton of a mesh, told by its parts, as JSON.
LAYOUT = "bone_layout"
# Bounds of what is read back: joints in a limb, and the numbers of parts.
MOST_JOINTS = 48
HIGHEST_PART = 100_000

NO_BONES = "{} has no armature of Eigenparts yet, so these bones are the mesh's own; create that armature first."


def remember(mesh: bpy.types.Mesh, layout: compute.BoneLayout | None) -> None:
    """Keep the layout of the bones that a mesh was given; None if there is none."""
    if layout is None:
        mesh[STATE].pop(LAYOUT, None)
        return
    limbs = [
        {
            "tips": sorted(tips),
            "joints": limb.joints,
            "borders": limb.borders,
            "parts": limb.parts,
            "has_carrier": limb.has_carrier,
        }
        for tips, limb in layout.limbs.items()
    ]
    root = [sorted(tips) for tips in layout.root]
    mesh[STATE][LAYOUT] = json.dumps({"parts": sorted(layout.parts), "root": root, "limbs": limbs})


def of_reference(mesh: bpy.types.Mesh) -> compute.BoneLayout | None:
    """Return the layout of the mesh that this one is registered to; None if it is not, or it has no bones."""
    reference = reference_of(mesh)
    return None if reference is None else read(reference.data)


def reference_of(mesh: bpy.types.Mesh) -> bpy.types.Object | None:
    """Return the mesh object that a mesh is registered to, if it is there."""
    match = registration_record.read(mesh)
    reference = bpy.data.objects.get(match.reference) if match is not None else None
    return reference if reference is not None and reference.type == "MESH" else None


def read(mesh: bpy.types.Mesh) -> compute.BoneLayout | None:
    """Return the layout that a mesh remembers; None if there is none, or it makes no sense."""
    state = mesh.get(STATE)
    text = state.get(LAYOUT) if hasattr(state, "to_dict") else None
    if not isinstance(text, str):
        return None
    try:
        stored = json.loads(text)
        limbs = {_tips(limb["tips"]): _limb(limb) for limb in stored["limbs"]}
        return compute.BoneLayout(_tips(stored["parts"]), frozenset(map(_tips, stored["root"])), limbs)
    except (KeyError, OverflowError, RecursionError, TypeError, ValueError):
        return None


def _tips(numbers: list[int]) -> frozenset[int]:
    return frozenset(_parts(numbers))


def _parts(numbers: list[int]) -> tuple[int, ...]:
    parts = tuple(int(number) for number in numbers)
    if not all(0 <= part <= HIGHEST_PART for part in parts):
        raise ValueError("There is no such part.")
    return parts


def _shares(numbers: list[float]) -> tuple[float, ...]:
    shares = tuple(float(number) for number in numbers)
    if not all(0 <= share <= 1 for share in shares) or list(shares) != sorted(shares):
        raise ValueError("Shares of the way along a limb rise from 0 to 1.")
    return shares


def _limb(stored: dict[str, Any]) -> compute.LimbLayout:
    joints, parts = _shares(stored["joints"]), _parts(stored["parts"])
    if not 2 <= len(joints) == len(parts) + 1 <= MOST_JOINTS:
        raise ValueError("A limb has a joint at either end of each bone.")
    return compute.LimbLayout(joints, _shares(stored["borders"]), parts, bool(stored["has_carrier"]))
