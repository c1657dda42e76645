"""The formats: how each is read and written, and what results are called."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...tasks.refusals import Refusal
from . import blend, fbx, gltf, obj, off_mesh, ply, stl
from .file_errors import reading_errors_told
from .open_file import OpenFile


@dataclass(frozen=True)
class Format:
    """A kind of file: read, written with what it can hold of the parts, and what its results are.

    Attributes
    ----------
    read : function
        Raises a Refusal if the file is damaged in a way that it knows.
    write : function
    output_suffix : str
    damage_of : function, optional
        Tells why Blender could not read a file.
    """

    read: Callable[[Path], OpenFile]
    write: Callable[[Path, OpenFile], None]
    output_suffix: str
    damage_of: Callable[[Path], Refusal] | None = None


def load(path: Path) -> OpenFile:
    """Open a file in place of what is open now and return its mesh objects that have faces, each mesh once."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise Refusal(f"files ending in {suffix!r} cannot be read; known are {' '.join(FORMATS)}.")
    if not path.is_file():
        raise Refusal("there is no such file.")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with reading_errors_told(path, FORMATS[suffix].damage_of):
        # Blender looks for what is relative in the folder it was started in, whatever a script has changed to.
        return FORMATS[suffix].read(path.absolute())


def save(path: Path, file: OpenFile) -> None:
    """Write the file that is open, in the format that the name says, one folder below its place."""
    FORMATS[path.suffix.lower()].write(path, file)


def name_of_divided(source: Path) -> str:
    """Return what the result of dividing a file is called, in its own format or one that holds more."""
    known = FORMATS.get(source.suffix.lower())
    return _name_of_result(source, "_parts", known.output_suffix if known else source.suffix)


def name_of_transferred(source: Path) -> str:
    """Return what the result of a transfer to a file is called; only a .blend holds all that can be transferred."""
    return _name_of_result(source, "_transferred", ".blend")


def _name_of_result(source: Path, ending: str, suffix: str) -> str:
    """Return a name that no other source has: its format is part of it if the result has another one."""
    kept = source.suffix.lower() == suffix
    return f"{source.stem if kept else source.name.replace('.', '_')}{ending}{suffix}"


# .stl can hold nothing of the parts, so its result is a .blend.
FORMATS = {
    ".blend": Format(blend.read_blend, blend.write_blend, ".blend", blend.damage_of_blend),
    ".obj": Format(obj.read_obj, obj.write_obj, ".obj"),
    ".ply": Format(ply.read_ply, ply.write_ply, ".ply"),
    ".stl": Format(stl.read_stl, blend.write_blend, ".blend"),
    ".glb": Format(gltf.read_gltf, gltf.write_gltf, ".glb"),
    ".gltf": Format(gltf.read_gltf, gltf.write_gltf, ".glb"),
    ".fbx": Format(fbx.read_fbx, fbx.write_fbx, ".fbx", fbx.damage_of_fbx),
    ".off": Format(off_mesh.read_off, off_mesh.write_off, ".off"),
}
