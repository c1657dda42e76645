"""Wavefront .obj files."""

from __future__ import annotations

import re
from pathlib import Path

import bpy

from ..results.stages import write_surely
from .open_file import OpenFile, open_file
from .part_materials import give_parts_materials
from .repairs import mended

FACE = re.compile(rb"^[ \t]*f[ \t]", re.MULTILINE)


def read_obj(path: Path) -> OpenFile:
    """Open a file, whose groups and objects are meshes."""
    # Blender would put points that are no numbers at the origin, and not tell.
    bpy.ops.wm.obj_import(filepath=str(path), validate_meshes=False)
    return open_file(mended(len(FACE.findall(path.read_bytes()))))


def write_obj(path: Path, file: OpenFile) -> None:
    """Write the meshes of the scene, with the parts in the names of materials."""
    give_parts_materials()
    write_surely(lambda: bpy.ops.wm.obj_export(filepath=str(path), export_materials=True, check_existing=False), path)
