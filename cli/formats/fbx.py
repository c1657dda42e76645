"""FBX files: bones, actions, cameras, lights, images and properties come out as they went in."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from ...tasks.refusals import Refusal
from .damage import cut_short, damaged
from .fbx_animation import stacks_written_once
from .open_file import OpenFile, open_file
from .own_attributes import claim_own_attributes
from .part_materials import give_parts_materials
from .repairs import WHOLE_FILE, other_faces, refuse_no_numbers

MAGIC, TEXT = b"Kaydara FBX Binary  \x00", b"; FBX"
# Bytes of the head, and the version from which places in the file have 64 bits.
HEAD, WIDE = 27, 7500
# What a file that is damaged, or no binary one, can raise; the importer is asked then, and says what is wrong.
DAMAGED = (
    *(OSError, ValueError, LookupError, TypeError, AttributeError, AssertionError, EOFError, ImportError),
    *(struct.error, zlib.error),
)


def read_fbx(path: Path) -> OpenFile:
    """Open a file, with its bones and actions."""
    shapes = list(_shapes(path))
    refuse_no_numbers({name: n_bad for name, n_bad, _ in shapes})
    # Blender's own reader is young; the add-on is what writes the results, so it is asked where it is there.
    read = bpy.ops.import_scene.fbx if "fbx" in dir(bpy.ops.import_scene) else bpy.ops.wm.fbx_import
    read(filepath=str(path))
    n_listed, n_faces = sum(count for _, _, count in shapes), sum(len(mesh.polygons) for mesh in bpy.data.meshes)
    repairs = {WHOLE_FILE: [other_faces(n_listed, n_faces)]} if shapes and n_listed != n_faces else {}
    return open_file(claim_own_attributes(repairs))


def write_fbx(path: Path, file: OpenFile) -> None:
    """Write all objects of the scene, with the parts in the names of materials."""
    give_parts_materials()
    with stacks_written_once():
        bpy.ops.export_scene.fbx(
            filepath=str(path),
            check_existing=False,
            # Bones at the ends of chains, and an action for each object that one fits, were not in the source.
            add_leaf_bones=False,
            bake_anim_use_all_actions=False,
            use_custom_props=True,
            path_mode="COPY",
            embed_textures=True,
        )


def damage_of_fbx(path: Path) -> Refusal:
    """Return what is wrong with an .fbx that Blender refused."""
    data = path.read_bytes()
    if data.lstrip().startswith(TEXT):
        return Refusal("it is an .fbx written as text, which Blender cannot read; export it as a binary .fbx.")
    if not data.startswith(MAGIC) or len(data) < HEAD:
        return damaged("byte 0: this is no binary .fbx file")
    (version,) = struct.unpack_from("<I", data, HEAD - 4)
    at, number = HEAD, "<Q" if version >= WIDE else "<I"
    while at + struct.calcsize(number) <= len(data):
        (end,) = struct.unpack_from(number, data, at)
        if end == 0:
            return damaged("a record of the .fbx file is damaged")
        if not at < end <= len(data):
            return damaged(f"byte {at}: a record ends at byte {end}, and the file has {len(data)}")
        at = end
    return cut_short(f"byte {len(data)}")


def _shapes(path: Path) -> Iterator[tuple[str, int, int]]:
    """Yield name, number of points that are no numbers and number of faces of each mesh, as far as they can be read."""
    try:
        root, _ = import_module("io_scene_fbx.parse_fbx").parse(str(path))
        objects = [part for part in root.elems if part.id == b"Objects"]
        shapes = [shape for part in objects for shape in part.elems if shape.id == b"Geometry"]
        found = [_shape(shape) for shape in shapes if shape.props[-1] == b"Mesh"]
    except DAMAGED:
        return
    yield from found


def _shape(shape: Any) -> tuple[str, int, int]:
    arrays = {
        part.id: np.asarray(part.props[0]) for part in shape.elems if part.id in (b"Vertices", b"PolygonVertexIndex")
    }
    places, corners = arrays.get(b"Vertices", np.empty(0)), arrays.get(b"PolygonVertexIndex", np.empty(0))
    n_bad = int((~np.isfinite(places.reshape(-1, 3)).all(axis=1)).sum())
    return shape.props[1].split(b"\x00")[0].decode("utf-8", "replace"), n_bad, int((corners < 0).sum())
