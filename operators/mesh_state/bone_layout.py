"""The layout of the bones that a mesh was given, kept with its analysis so that registered meshes get the same."""

from __future__ import annotations

import json
from typing import Any

from ... import compute
from .schema import BONE_LAYOUT

# Bounds of what is read back: joints in a limb, and the numbers of parts.
MOST_JOINTS = 48
HIGHEST_PART = 100_000

NO_BONES = "{} has no armature of Eigenparts yet, so these bones are the mesh's own; create that armature first."


def packed_layout(layout: compute.BoneLayout | None) -> dict[str, Any]:
    """Return the layout of the bones that a mesh was given as a text of the state; None if there is none."""
    if layout is None:
        return {BONE_LAYOUT: None}
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
    return {BONE_LAYOUT: json.dumps({"parts": sorted(layout.parts), "root": root, "limbs": limbs})}


def unpacked_layout(text: Any) -> compute.BoneLayout | None:
    """Return the layout in a text; None if there is none, or it makes no sense."""
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
