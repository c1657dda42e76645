"""What a .gltf or .glb file says of itself, looked at before Blender opens it."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from .damage import cut_short, damaged

# What a .glb begins with, and its version.
MAGIC, VERSION = b"glTF", 2
JSON_CHUNK, BINARY_CHUNK = b"JSON", b"BIN\0"
COMPONENT_SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
N_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# A name of a file that is longer is none on any system.
LONGEST_NAME = 4096

# Parsed JSON, of which nothing is known.
Table = dict[str, Any]


def parse_gltf(path: Path) -> tuple[Table, list[memoryview]]:
    """Return the table of contents of a file and its buffers, which fit together.

    Raises
    ------
    Refusal
        If it has not the chunks and files that it should have, or these are not what they say.
    """
    text, chunk, where = path.read_bytes(), b"", ""
    if path.suffix.lower() == ".glb":
        (text, chunk), where = _json_and_binary(text), "chunk JSON, "
    table = _parsed(text, where)
    rows = enumerate(rows_of(table, "buffers"))
    buffers = [_buffer(buffer, f"buffers[{number}]", path.parent, chunk) for number, buffer in rows]
    _check_tables(table, buffers)
    return table, buffers


def rows_of(table: Table, name: str) -> list[Table]:
    """Return the tables in a list of a table; raises a Refusal if there is something else."""
    rows = table.get(name, [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise damaged(f'"{name}" is not a list of tables')
    return rows


def _json_and_binary(data: bytes) -> tuple[bytes, bytes]:
    """Return the two chunks of a .glb, the second of which may be missing."""
    if len(data) < 12 or data[:4] != MAGIC:
        raise damaged('byte 0: it does not begin with "glTF" as a .glb does')
    version, length = struct.unpack_from("<II", data, 4)
    if version != VERSION:
        raise damaged(f"byte 4: it is of version {version} of glTF, and only {VERSION} can be read")
    if length != len(data):
        raise damaged(f"byte 8: the file should have {length} bytes and has {len(data)}")
    chunks = _chunks(data)
    if not chunks or chunks[0][0] != JSON_CHUNK:
        raise damaged("byte 12: the first chunk is not JSON")
    return chunks[0][1], chunks[1][1] if len(chunks) > 1 and chunks[1][0] == BINARY_CHUNK else b""


def _chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    chunks, at = list[tuple[bytes, bytes]](), 12
    while at < len(data):
        if at + 8 > len(data):
            raise cut_short(f"byte {at}, chunk {len(chunks)}")
        length, kind = struct.unpack_from("<I4s", data, at)
        if at + 8 + length > len(data):
            raise cut_short(f"byte {at}, chunk {len(chunks)} of {length} bytes")
        chunks.append((kind, data[at + 8 : at + 8 + length]))
        at += 8 + length
    return chunks


def _parsed(text: bytes, where: str) -> Table:
    try:
        table = json.loads(text.decode("utf-8-sig").rstrip("\0"))
    except UnicodeDecodeError as error:
        raise damaged(f"{where}byte {error.start}: there is something that is no text") from error
    except json.JSONDecodeError as error:
        raise damaged(f"{where}line {error.lineno}, column {error.colno}: this is no JSON") from error
    except RecursionError as error:
        raise damaged(f"{where}the tables are nested too deep") from error
    if not isinstance(table, dict):
        raise damaged(f"{where}line 1: there is no table of contents")
    return table


def _check_tables(table: Table, buffers: list[memoryview]) -> None:
    """Raise a Refusal if buffers, views and accessors do not lie within each other."""
    views = [_view_size(view, number, buffers) for number, view in enumerate(rows_of(table, "bufferViews"))]
    for number, accessor in enumerate(rows_of(table, "accessors")):
        _check_accessor(accessor, number, rows_of(table, "bufferViews"), views)
    for number, mesh in enumerate(rows_of(table, "meshes")):
        for primitive in rows_of(mesh, "primitives"):
            used = [*_table(primitive, "attributes").values(), primitive.get("indices", 0)]
            if not all(_is_index(accessor, len(rows_of(table, "accessors"))) for accessor in used):
                raise damaged(f"meshes[{number}]: it uses an accessor that is not there")


def _table(table: Table, name: str) -> Table:
    inner = table.get(name, {})
    if not isinstance(inner, dict):
        raise damaged(f'"{name}" is not a table')
    return inner


def _is_index(value: object, n: int) -> bool:
    return isinstance(value, int) and 0 <= value < n


def _number(row: Table, name: str, where: str, default: int | None = None) -> int:
    value = row.get(name, default)
    if not isinstance(value, int) or value < 0:
        raise damaged(f'{where}: "{name}" is no number of bytes or entries')
    return value


def _buffer(buffer: Table, where: str, folder: Path, chunk: bytes) -> memoryview:
    """Return the bytes of a buffer, as many as it says."""
    size, uri = _number(buffer, "byteLength", where), buffer.get("uri")
    if "uri" not in buffer:
        data = chunk
    elif not isinstance(uri, str) or "\0" in uri:
        raise damaged(f"{where}: it names no file")
    else:
        data = _decoded(uri, where) if uri.startswith("data:") else _bytes_of_file(folder, unquote(uri), where)
    if len(data) < size:
        raise cut_short(f"{where}: {len(data)} of {size} bytes are there")
    return memoryview(data)[:size]


def _decoded(uri: str, where: str) -> bytes:
    try:
        return base64.b64decode(uri.partition(",")[2])
    except ValueError as error:
        raise damaged(f"{where}: its bytes are not encoded as they should be") from error


def _bytes_of_file(folder: Path, name: str, where: str) -> bytes:
    path = folder / name
    if len(name) > LONGEST_NAME or "\0" in name or not path.is_file():
        raise damaged(f'{where}: there is no file "{name[:80]}" beside it')
    return path.read_bytes()


def _view_size(view: Table, number: int, buffers: list[memoryview]) -> int:
    where = f"bufferViews[{number}]"
    size, offset = _number(view, "byteLength", where), _number(view, "byteOffset", where, 0)
    buffer = view.get("buffer")
    # Extensions have buffers that are not there until they are decoded.
    if not _is_index(buffer, len(buffers)) or offset + size > len(buffers[int(str(buffer))]):
        raise damaged(f"{where}: it reaches beyond its buffer")
    return size


def _check_accessor(accessor: Table, number: int, views: list[Table], sizes: list[int]) -> None:
    where = f"accessors[{number}]"
    component, kind = accessor.get("componentType"), accessor.get("type")
    if component not in COMPONENT_SIZES or kind not in N_COMPONENTS:
        raise damaged(f"{where}: it has no type that is known")
    count, offset = _number(accessor, "count", where), _number(accessor, "byteOffset", where, 0)
    view = accessor.get("bufferView")
    if view is None or count == 0:
        return
    if not _is_index(view, len(views)):
        raise damaged(f"{where}: it uses a buffer view that is not there")
    size = COMPONENT_SIZES[component] * N_COMPONENTS[kind]
    stride = _number(views[view], "byteStride", where, 0) or size
    if offset + stride * (count - 1) + size > sizes[view]:
        raise damaged(f"{where}: its {count} entries reach beyond bufferViews[{view}]")
