"""Read meshes from files and write divided ones: Blender's importers and exporters, and our own for .off."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy

from ..operators.blender.known_values import mesh_of
from ..operators.messages.user_errors import Refusal
from .atomic_write import staged
from .materials import give_parts_materials
from .off import read_off, write_off
from .reading.reading_errors import reading_errors_told


@dataclass(frozen=True)
class Format:
    """A kind of file: read, and written with what it can hold of the parts."""

    read: Callable[[Path], None]
    write: Callable[[Path], None]
    output_suffix: str


def load(path: Path) -> list[bpy.types.Object]:
    """Open a file in place of what is open now and return its mesh objects that have faces, each mesh once."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise Refusal(f"files ending in {suffix!r} cannot be read; known are {' '.join(FORMATS)}.")
    if not path.is_file():
        raise Refusal("there is no such file.")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # Blender looks for what is relative in the folder it was started in, whatever a script has changed to.
    with reading_errors_told(path):
        FORMATS[suffix].read(path.absolute())
    objects = {
        mesh_of(obj): obj for obj in reversed(bpy.data.objects) if obj.type == "MESH" and mesh_of(obj).library is None
    }
    if not objects:
        raise Refusal("there is no mesh in this file.")
    # Guides and the shapes of bones have no faces; where there are others, nobody wants these divided.
    divisible = [obj for obj in objects.values() if mesh_of(obj).polygons]
    return sorted(divisible or objects.values(), key=lambda obj: obj.name)


def name_of_divided(source: Path) -> str:
    """Return what the result of dividing a file is called, in its own format or one that holds more."""
    known = FORMATS.get(source.suffix.lower())
    return _name_of_result(source, "_parts", known.output_suffix if known else source.suffix)


def name_of_transferred(source: Path) -> str:
    """Return what the result of a transfer to a file is called; only a .blend holds all that can be transferred."""
    return _name_of_result(source, "_transferred", ".blend")


def save(target: Path) -> None:
    """Write what is open now, in the format that the name says."""
    with staged(target.absolute()) as stage:
        FORMATS[target.suffix.lower()].write(stage)


def _name_of_result(source: Path, ending: str, suffix: str) -> str:
    """Return a name that no other source has: its format is part of it if the result has another one."""
    kept = source.suffix.lower() == suffix
    return f"{source.stem if kept else source.name.replace('.', '_')}{ending}{suffix}"


def _read_blend(path: Path) -> None:
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)


def _write_blend(path: Path) -> None:
    # The file is written one folder below its place, so Blender must not adapt the paths inside it.
    if bpy.data.filepath and Path(bpy.data.filepath).parent.resolve() != path.parent.parent.resolve():
        bpy.ops.file.make_paths_absolute()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, check_existing=False, relative_remap=False)


def _read_obj(path: Path) -> None:
    bpy.ops.wm.obj_import(filepath=str(path))


def _write_obj(path: Path) -> None:
    give_parts_materials()
    bpy.ops.wm.obj_export(filepath=str(path), export_materials=True, check_existing=False)


def _read_ply(path: Path) -> None:
    bpy.ops.wm.ply_import(filepath=str(path))


def _write_ply(path: Path) -> None:
    bpy.ops.wm.ply_export(filepath=str(path), export_colors="SRGB", export_attributes=True, check_existing=False)


def _read_stl(path: Path) -> None:
    bpy.ops.wm.stl_import(filepath=str(path))


def _read_gltf(path: Path) -> None:
    bpy.ops.import_scene.gltf(filepath=str(path))


def _write_gltf(path: Path) -> None:
    give_parts_materials()
    bpy.ops.export_scene.gltf(filepath=str(path), export_format="GLB", check_existing=False)


def _read_fbx(path: Path) -> None:
    # Blender 5 has its own reader; the add-on's is still there in some versions.
    read = bpy.ops.wm.fbx_import if hasattr(bpy.types, "WM_OT_fbx_import") else bpy.ops.import_scene.fbx
    read(filepath=str(path))


def _write_fbx(path: Path) -> None:
    give_parts_materials()
    bpy.ops.export_scene.fbx(filepath=str(path), check_existing=False)


# .stl can hold nothing of the parts, so its result is a .blend.
FORMATS = {
    ".blend": Format(_read_blend, _write_blend, ".blend"),
    ".obj": Format(_read_obj, _write_obj, ".obj"),
    ".ply": Format(_read_ply, _write_ply, ".ply"),
    ".stl": Format(_read_stl, _write_blend, ".blend"),
    ".glb": Format(_read_gltf, _write_gltf, ".glb"),
    ".gltf": Format(_read_gltf, _write_gltf, ".glb"),
    ".fbx": Format(_read_fbx, _write_fbx, ".fbx"),
    ".off": Format(read_off, write_off, ".off"),
}
