"""Actions of an .fbx file that come out as they went in: a stack of the file is written as one stack again.

The exporter writes each strip of each object as a stack in which everything has keys, so that the next import makes an
action of every object for every strip. Here the actions of a stack are laid over each other, one stack behind the
other, and the exporter is told to write each stack once, with those that had keys in it.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import bpy

from ...operators.blender.known_values import present

# Frames between two stacks.
GAP = 10
# What the importer adds to the name of a stack, for the layer that the exporter makes.
LAYER = "|BaseLayer"
NUMBER = re.compile(r"\.\d{3}$")

Owner = bpy.types.Object | bpy.types.Key | bpy.types.Camera


@dataclass(frozen=True, eq=False)
class _Stack:
    """Strips that play together, by what they move."""

    strips: dict[Owner, bpy.types.NlaStrip]

    def is_written_with(self, strip: bpy.types.NlaStrip) -> bool:
        """Whether a strip is the one of the stack that the exporter is to write all of them with."""
        return strip == next(own for owner, own in self.strips.items() if isinstance(owner, bpy.types.Object))


@contextmanager
def stacks_written_once() -> Iterator[None]:
    """Lay out the actions that are open, and let the exporter write each stack of them once."""
    stacks = _laid_out()
    exporter: Any = import_module("io_scene_fbx.export_fbx_bin")
    write = exporter.fbx_animations_do

    def write_stack(scene: Any, strip: bpy.types.NlaStrip, *arguments: Any, **options: Any) -> Any:
        stack = next((stack for stack in stacks if strip in stack.strips.values()), None)
        if stack is None or not stack.is_written_with(strip):
            return None
        options["objects"] = {obj for obj in scene.objects if obj.is_object and obj.bdata in stack.strips}
        for own in stack.strips.values():
            own.mute = False
        try:
            return write(_with_keys_of(scene, stack), strip, *arguments, **options)
        finally:
            for own in stack.strips.values():
                own.mute = True

    exporter.fbx_animations_do = write_stack
    try:
        yield
    finally:
        exporter.fbx_animations_do = write


def _with_keys_of(scene: Any, stack: _Stack) -> Any:
    """Return what is exported without the shape keys and cameras that have no keys in a stack."""
    shapes = {mesh: value for mesh, value in scene.data_deformers_shape.items() if mesh.shape_keys in stack.strips}
    cameras = {obj: key for obj, key in scene.data_cameras.items() if obj.bdata.data in stack.strips}
    return scene._replace(data_deformers_shape=shapes, data_cameras=cameras)


def _laid_out() -> list[_Stack]:
    """Give each action a strip, those of one stack over each other, and one stack behind the other."""
    actions: dict[str, dict[Owner, bpy.types.Action]] = defaultdict(dict)
    for action in bpy.data.actions:
        if (owner := _owner_of(action)) is not None:
            actions[_name_of_stack(action)].setdefault(owner, action)
    for owner in {owner for owners in actions.values() for owner in owners}:
        _stop(owner)
    first, stacks = 1, []
    for name, owners in actions.items():
        _add_carrier(owners)
        stacks.append(_Stack({owner: _strip(owner, action, name, first) for owner, action in owners.items()}))
        first = GAP + int(max(strip.frame_end for strip in stacks[-1].strips.values()))
    return stacks


def _owner_of(action: bpy.types.Action) -> Owner | None:
    """Return what an action was made for: the importer calls it "owner|stack|layer"."""
    name = action.name.partition("|")[0]
    owners = [known[name] for known in (bpy.data.objects, bpy.data.shape_keys, bpy.data.cameras) if name in known]
    return next((owner for owner in owners if _is_made_for(action, owner)), None)


def _is_made_for(action: bpy.types.Action, owner: Owner) -> bool:
    if getattr(action, "slots", ()):
        return action.slots[0].target_id_type == owner.id_type
    # Until Blender 4.3 an action does not know what it moves.
    try:
        curves: Any = getattr(action, "fcurves", ())
        owner.path_resolve(curves[0].data_path)
    except (IndexError, ValueError):
        return False
    return True


def _name_of_stack(action: bpy.types.Action) -> str:
    # The number is that of another action of this name, such as that of the camera in an object.
    name = NUMBER.sub("", action.name).partition("|")[2] or action.name
    return name.removesuffix(LAYER)


def _add_carrier(owners: dict[Owner, bpy.types.Action]) -> None:
    """Let an object carry a stack of shape keys or cameras alone, as only strips of objects are written."""
    if not any(isinstance(owner, bpy.types.Object) for owner in owners):
        data = next(iter(owners))
        carriers = (
            obj for obj in bpy.data.objects if obj.data == data or getattr(obj.data, "shape_keys", None) == data
        )
        owners[next(carriers)] = bpy.data.actions.new("carrier")


def _stop(owner: Owner) -> None:
    data = present(owner.animation_data or owner.animation_data_create())
    data.action = None
    for track in list(data.nla_tracks):
        data.nla_tracks.remove(track)


def _strip(owner: Owner, action: bpy.types.Action, name: str, first: int) -> bpy.types.NlaStrip:
    data = present(owner.animation_data or owner.animation_data_create())
    strip = data.nla_tracks.new().strips.new(name, first, action)
    strip.name, strip.extrapolation = name, "NOTHING"
    if getattr(action, "slots", ()):
        strip.action_slot = action.slots[0]
    return strip
