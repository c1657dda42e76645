"""The formats: how each is read and written, and what results are called."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...operators.blender.known_values import mesh_of
from ...operators.messages.user_errors import Refusal
from ..reading.reading_errors import reading_errors_told
from . import fbx, gltf, obj, off_mesh, ply, stl
from .own_attributes import claim_own_attributes
from .repairs import WHOLE_FILE, Repairs


@dataclass(frozen=True)
class Format:
    """A kind of file: read, which returns what was mended, and written with what it can hold of the parts."""

    read: Callable[[Path], Repairs]
    write: Callable[[Path], None]
    output_suffix: str


@dataclass(frozen=True, eq=False)
class OpenFile:
    """The meshes of the file that is open.

    Attributes
    ----------
    objects : list of Object
        One for each mesh, by name.
    repairs : Repairs
        What was mended when they were read.
    """

    objects: list[bpy.types.Object]
    repairs: Repairs

    def repairs_of(self, obj: bpy.types.Object) -> list[str]:
        """Return what was mended of the mesh of an object, and of the file as a whole."""
        return [*self.repairs.get(WHOLE_FILE, ()), *self.repairs.get(mesh_of(obj).name, ())]


def load(path: Path) -> OpenFile:
    """Open a file in place of what is open now and return its mesh objects that have faces, each mesh once."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise Refusal(f"files ending in {suffix!r} cannot be read; known are {' '.join(FORMATS)}.")
    if not path.is_file():
        raise Refusal("there is no such file.")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # Blender looks for what is relative in the folder it was started in, whatever a script has changed to.
    with reading_errors_told(path):
        repairs = FORMATS[suffix].read(path.absolute())
    return OpenFile(_objects_with_meshes(), repairs)


def name_of_divided(source: Path) -> str:
    """Return what the result of dividing a file is called, in its own format or one that holds more."""
    known = FORMATS.get(source.suffix.lower())
    return _name_of_result(source, "_parts", known.output_suffix if known else source.suffix)


def name_of_transferred(source: Path) -> str:
    """Return what the result of a transfer to a file is called; only a .blend holds all that can be transferred."""
    return _name_of_result(source, "_transferred", ".blend")


def save(path: Path) -> None:
    """Write what is open now, in the format that the name says, one folder below its place."""
    FORMATS[path.suffix.lower()].write(path)


def _objects_with_meshes() -> list[bpy.types.Object]:
    meshes = [obj for obj in bpy.data.objects if obj.type == "MESH" and mesh_of(obj).library is None]
    shapes_of_bones = _shapes_of_bones()
    objects = {mesh_of(obj): obj for obj in reversed(meshes) if obj not in shapes_of_bones}
    if not objects:
        raise Refusal(
            "there is no mesh in this file but the shapes of bones." if meshes else "there is no mesh in this file."
        )
    # Guides have no faces; where there are others, nobody wants these divided.
    divisible = [obj for obj in objects.values() if mesh_of(obj).polygons]
    return sorted(divisible or objects.values(), key=lambda obj: obj.name)


def _shapes_of_bones() -> set[bpy.types.Object]:
    """Return the objects that bones are only shown as."""
    bones = [bone for obj in bpy.data.objects if obj.pose for bone in obj.pose.bones]
    return {bone.custom_shape for bone in bones if bone.custom_shape is not None}


def _name_of_result(source: Path, ending: str, suffix: str) -> str:
    """Return a name that no other source has: its format is part of it if the result has another one."""
    kept = source.suffix.lower() == suffix
    return f"{source.stem if kept else source.name.replace('.', '_')}{ending}{suffix}"


def _read_blend(path: Path) -> Repairs:
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    return {}


def _write_blend(path: Path) -> None:
    # The file is written one folder below its place, so Blender must not adapt the paths inside it.
    if bpy.data.filepath and Path(bpy.data.filepath).parent.resolve() != path.parent.parent.resolve():
        bpy.ops.file.make_paths_absolute()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, check_existing=False, relative_remap=False)


def _adopting(read: Callable[[Path], Repairs]) -> Callable[[Path], Repairs]:
    """Return a reader that also takes back as ours what a result of ours brings along."""

    def read_and_adopt(path: Path) -> Repairs:
        repairs = read(path)
        for mesh in bpy.data.meshes:
            told = claim_own_attributes(mesh)
            if told:
                repairs[mesh.name] = [*repairs.get(mesh.name, ()), *told]
        return repairs

    return read_and_adopt


# .stl can hold nothing of the parts, so its result is a .blend.
FORMATS = {
    ".blend": Format(_read_blend, _write_blend, ".blend"),
    ".obj": Format(obj.read_obj, obj.write_obj, ".obj"),
    ".ply": Format(_adopting(ply.read_ply), ply.write_ply, ".ply"),
    ".stl": Format(stl.read_stl, _write_blend, ".blend"),
    ".glb": Format(_adopting(gltf.read_gltf), gltf.write_gltf, ".glb"),
    ".gltf": Format(_adopting(gltf.read_gltf), gltf.write_gltf, ".glb"),
    ".fbx": Format(_adopting(fbx.read_fbx), fbx.write_fbx, ".fbx"),
    ".off": Format(off_mesh.read_off, off_mesh.write_off, ".off"),
}
