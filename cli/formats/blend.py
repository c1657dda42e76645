"""Blender's own files, and where one that Blender refused is damaged."""

from __future__ import annotations

import struct
from pathlib import Path

import bpy

from ...tasks.refusals import Refusal
from .damage import MEND, cut_short, damaged
from .open_file import OpenFile, open_file

MAGIC = b"BLENDER"
COMPRESSED = (b"\x28\xb5\x2f\xfd", b"\x1f\x8b")


def read_blend(path: Path) -> OpenFile:
    """Open a file as the window does, without running what is in it."""
    bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    return open_file({})


def write_blend(path: Path, file: OpenFile) -> None:
    """Write all that is open."""
    # The file is written one folder below its place, so Blender must not adapt the paths inside it.
    if bpy.data.filepath and Path(bpy.data.filepath).parent.resolve() != path.parent.parent.resolve():
        bpy.ops.file.make_paths_absolute()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, check_existing=False, relative_remap=False)


def damage_of_blend(path: Path) -> Refusal:
    """Return what is wrong with a .blend that Blender refused."""
    data = path.read_bytes()
    if data.startswith(COMPRESSED):
        return damaged("it is damaged or cut short (and compressed, so that nobody can say where)")
    if not data.startswith(MAGIC):
        return damaged("byte 0: this is no .blend file")
    version = _version_of_blend(data)
    if version is None or not (offset := _first_block(data)):
        return damaged("byte 7: the head of the .blend file is damaged")
    if version > bpy.app.version[:2]:
        return Refusal(
            f"it was saved by Blender {version[0]}.{version[1]}, and this is Blender {bpy.app.version_string}; "
            "open it with that version or a later one."
        )
    return _damaged_block(data, offset)


def _version_of_blend(data: bytes) -> tuple[int, int] | None:
    """Return (4, 5) for "BLENDER-v405" and "BLENDER17-01v0405"."""
    digits = data[13:17] if data[7:9].isdigit() else data[9:12]
    return (int(digits) // 100, int(digits) % 100) if digits.isdigit() else None


def _first_block(data: bytes) -> int:
    """Return where the first block begins; 0 if the head says nothing that is known."""
    if data[7:9].isdigit():
        return int(data[7:9])
    return 12 if data[7:8] in b"_-" and data[8:9] in b"vV" else 0


def _damaged_block(data: bytes, at: int) -> Refusal:
    """Return where the blocks of a .blend end too early, or that one of them is damaged."""
    order = ">" if data[8:9] == b"V" else "<"
    # Code, size, and what else the head of a block has.
    head, size_at, size_type = (32, 16, "q") if data[7:9].isdigit() else (20 if data[7:8] == b"_" else 24, 4, "i")
    while at + head <= len(data):
        if data[at : at + 4] == b"ENDB":
            return Refusal(f"a block within the .blend file is damaged; {MEND}")
        (size,) = struct.unpack_from(order + size_type, data, at + size_at)
        if size < 0 or at + head + size > len(data):
            return cut_short(f"byte {at}, within a block of {size} bytes")
        at += head + size
    return cut_short(f"byte {len(data)}")
