"""Where a .blend, .fbx or .stl file that Blender could not read is damaged, as far as a look at it tells."""

import struct
from pathlib import Path

import bpy

from ...operators.messages.user_errors import Refusal
from .damage import MEND, cut_short, damaged

BLEND = b"BLENDER"
COMPRESSED = (b"\x28\xb5\x2f\xfd", b"\x1f\x8b")
FBX, FBX_AS_TEXT = b"Kaydara FBX Binary  \x00", b"; FBX"
# Bytes of the head of a binary .stl, with the number of triangles at its end, and of each triangle.
STL_HEAD, STL_TRIANGLE = 84, 50
WIDE_FBX = 7500


def check_stl(path: Path) -> None:
    """Raise a Refusal if a binary .stl has fewer triangles than it says."""
    size = path.stat().st_size
    with open(path, "rb") as stream:
        head = stream.read(STL_HEAD)
    if head.lstrip().startswith(b"solid"):
        return
    if len(head) < STL_HEAD:
        raise cut_short(f"byte {size}, within the head")
    (n_triangles,) = struct.unpack_from("<I", head, STL_HEAD - 4)
    n_there = (size - STL_HEAD) // STL_TRIANGLE
    if n_there < n_triangles:
        raise cut_short(f"byte {size}, after {n_there} of {n_triangles} triangles")


def damage_of_blend(path: Path) -> Refusal:
    """Return what is wrong with a .blend that Blender refused."""
    data = path.read_bytes()
    if data.startswith(COMPRESSED):
        return damaged("it is damaged or cut short (and compressed, so that nobody can say where)")
    if not data.startswith(BLEND):
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


def damage_of_fbx(path: Path) -> Refusal:
    """Return what is wrong with an .fbx that Blender refused."""
    data = path.read_bytes()
    if data.lstrip().startswith(FBX_AS_TEXT):
        return Refusal("it is an .fbx written as text, which Blender cannot read; export it as a binary .fbx.")
    if not data.startswith(FBX) or len(data) < 27:
        return damaged("byte 0: this is no binary .fbx file")
    (version,) = struct.unpack_from("<I", data, 23)
    at, number = 27, "<Q" if version >= WIDE_FBX else "<I"
    while at + struct.calcsize(number) <= len(data):
        (end,) = struct.unpack_from(number, data, at)
        if end == 0:
            return damaged("a record of the .fbx file is damaged")
        if not at < end <= len(data):
            return damaged(f"byte {at}: a record ends at byte {end}, and the file has {len(data)}")
        at = end
    return cut_short(f"byte {len(data)}")


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
