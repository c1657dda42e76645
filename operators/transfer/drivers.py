"""Drivers of shape keys as values: read from one object, and written for another, so that they follow what it has."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, cast

import bpy

from ...tasks.shape_key_settings import DriverTarget, Settings, ShapeKeyDriver
from ..blender.known_values import data_of, mesh_of, present
from .rna_settings import read_settings, write_settings

# Where data of each kind is found by its name.
KEPT_IN = {
    **dict(OBJECT="objects", KEY="shape_keys", MESH="meshes", ARMATURE="armatures", SCENE="scenes", WORLD="worlds"),
    **dict(MATERIAL="materials", CAMERA="cameras", LIGHT="lights", COLLECTION="collections", NODETREE="node_groups"),
}
OBJECT, MESH, KEYS, RIG, BONES = "OBJECT", "MESH", "KEYS", "RIG", "BONES"
QUOTED = re.compile(r'\["([^"]+)"\]')


def read_drivers(obj: bpy.types.Object, block: bpy.types.ShapeKey) -> tuple[ShapeKeyDriver, ...]:
    """Return the drivers of a shape key of an object."""
    data = present(mesh_of(obj).shape_keys).animation_data
    start = f"{block.path_from_id()}."
    found = [curve for curve in data.drivers if curve.data_path.startswith(start)] if data else []
    return tuple(_read(obj, curve, curve.data_path.removeprefix(start)) for curve in found)


def flipped_driver(driver: ShapeKeyDriver) -> ShapeKeyDriver:
    """Return the driver of the mirrored key: what it reads on the left is on the right."""
    variables = tuple((settings, tuple(map(_flipped, targets))) for settings, targets in driver.variables)
    return replace(driver, variables=variables)


def write_drivers(obj: bpy.types.Object, name: str, drivers: tuple[ShapeKeyDriver, ...]) -> set[str]:
    """Give a shape key drivers, and return the names of what they read that is not the object's own."""
    block = present(mesh_of(obj).shape_keys).key_blocks[name]
    return {strange for driver in drivers for strange in _write(obj, block, driver)}


def remove_drivers(block: bpy.types.ShapeKey) -> None:
    """Take the drivers of a shape key away."""
    for setting in ("value", "mute", "slider_min", "slider_max"):
        block.driver_remove(setting)


def _read(obj: bpy.types.Object, curve: bpy.types.FCurve, setting: str) -> ShapeKeyDriver:
    driver = present(curve.driver)
    return ShapeKeyDriver(
        setting=setting,
        settings=read_settings(driver),
        curve=read_settings(curve, leave_out=("data_path", "array_index", "select", "hide")),
        variables=tuple(
            (read_settings(variable), tuple(_read_target(obj, target) for target in variable.targets))
            for variable in driver.variables
        ),
        keyframes=tuple(map(read_settings, curve.keyframe_points)),
        modifiers=tuple(read_settings(modifier) | {"type": modifier.type} for modifier in curve.modifiers),
    )


def _read_target(obj: bpy.types.Object, target: bpy.types.DriverTarget) -> DriverTarget:
    read = target.id
    role = next((role for role, own in _own_data(obj).items() if own is not None and own == read), "")
    kind, name = ("", "") if read is None else (read.id_type, read.name)
    return DriverTarget(role, kind, name, read_settings(target, leave_out=("id_type",)))


def _own_data(obj: bpy.types.Object) -> dict[str, bpy.types.ID | None]:
    """Return what an object has of its own, by its role."""
    rig = rig_of(obj)
    mesh = mesh_of(obj)
    return {OBJECT: obj, MESH: mesh, KEYS: mesh.shape_keys, RIG: rig, BONES: None if rig is None else rig.data}


def rig_of(obj: bpy.types.Object) -> bpy.types.Object | None:
    """Return the armature that deforms an object; None if there is none."""
    return next(iter(rigs_of(obj)), None)


def rigs_of(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """Return the armatures that may move an object: those of its modifiers, and its parent."""
    moved_by = [modifier.object for modifier in obj.modifiers if isinstance(modifier, bpy.types.ArmatureModifier)]
    return [rig for rig in (*moved_by, obj.parent) if rig is not None and rig.type == "ARMATURE"]


def _flipped(target: DriverTarget) -> DriverTarget:
    settings = dict(target.settings)
    settings["bone_target"] = bpy.utils.flip_name(settings["bone_target"]) if settings["bone_target"] else ""
    settings["data_path"] = QUOTED.sub(lambda found: f'["{bpy.utils.flip_name(found[1])}"]', settings["data_path"])
    return replace(target, settings=settings)


def _write(obj: bpy.types.Object, block: bpy.types.ShapeKey, given: ShapeKeyDriver) -> Iterator[str]:
    curve = cast(bpy.types.FCurve, block.driver_add(given.setting))
    driver = present(curve.driver)
    for settings, targets in given.variables:
        variable = driver.variables.new()
        write_settings(variable, settings)
        for target, read in zip(variable.targets, targets, strict=True):
            yield from _write_target(obj, target, read)
    _write_curve(curve, given)
    # The expression comes last: it is understood with the variables that are there.
    write_settings(driver, given.settings)


def _write_curve(curve: bpy.types.FCurve, given: ShapeKeyDriver) -> None:
    write_settings(curve, given.curve)
    for modifier in list(curve.modifiers):
        curve.modifiers.remove(modifier)
    for settings in given.modifiers:
        write_settings(present(curve.modifiers.new(settings["type"])), settings)
    curve.keyframe_points.clear()
    curve.keyframe_points.add(len(given.keyframes))
    for point, settings in zip(curve.keyframe_points, given.keyframes, strict=True):
        write_settings(point, settings)


def _write_target(obj: bpy.types.Object, target: bpy.types.DriverTarget, read: DriverTarget) -> Iterator[str]:
    """Let a variable read what is the object's own, otherwise what it read before, whose name is yielded."""
    own = _own_data(obj).get(read.role)
    is_own = own is not None and _has(own, read.settings)
    known: Any = getattr(bpy.data, KEPT_IN[read.id_type]).get(read.name) if read.id_type in KEPT_IN else None
    if read.id_type:
        write_settings(target, {"id_type": read.id_type})
    target.id = own if is_own else known
    write_settings(target, read.settings)
    if not is_own and read.id_type not in ("", "SCENE"):
        yield read.name


def _has(data: bpy.types.ID, settings: Settings) -> bool:
    """Whether data has the bone and the value that a variable reads."""
    bone, path = settings["bone_target"], settings["data_path"]
    if bone and isinstance(data, bpy.types.Object):
        return data.type == "ARMATURE" and bone in data_of(data, bpy.types.Armature).bones
    resolve: Callable[[str], object] = data.path_resolve
    try:
        return not path or resolve(path) is not None
    except ValueError:
        return False
