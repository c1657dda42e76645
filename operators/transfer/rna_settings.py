"""The settings of anything of Blender's as plain values, which outlive the file that they were read from."""

from __future__ import annotations

from typing import Any

import bpy

from ...tasks.shape_key_settings import Settings

PLAIN = ("BOOLEAN", "INT", "FLOAT", "STRING", "ENUM")


def read_settings(owner: bpy.types.bpy_struct[Any], leave_out: tuple[str, ...] = ()) -> Settings:
    """Return all settings that are plain values and can be set."""
    return {
        setting.identifier: _plain(getattr(owner, setting.identifier), setting)
        for setting in owner.bl_rna.properties
        if setting.type in PLAIN and not setting.is_readonly and setting.identifier not in leave_out
    }


def write_settings(owner: bpy.types.bpy_struct[Any], settings: Settings) -> None:
    """Set what can be set here; another type of the same thing may lack some."""
    for name, value in settings.items():
        if hasattr(owner, name) and not owner.is_property_readonly(name):
            setattr(owner, name, value)


def _plain(value: Any, setting: Any) -> Any:
    return tuple(value) if getattr(setting, "is_array", False) else value
