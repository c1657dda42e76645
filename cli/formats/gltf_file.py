"""What a .gltf or .glb file says of itself, looked at before Blender opens it."""

from __future__ import annotations

import base64
import json
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from .damage import cut_short, damaged

# What a .glb begins with, and its version.
MAGIC, VERSION = b"glTF", 2
JSON_CHUNK, BINARY_CHUNK = b"JSON", b"BIN\0"
FLOAT32, TRIANGLES = 5126, 4
COMPONENT_SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, FLOAT32: 4}
N_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# A name of a file that is longer is none on any system.
LONGEST_NAME = 4096

# Parsed JSON, of which nothing is known.
Table = dict[str, Any]


@dataclass(frozen=True, eq=False)
class GltfFile:
    """A file whose tables fit together.

    Attributes
    ----------
    table : dict
        Of contents.
    chunk : bytes
        The binary one of a .glb.
    folder : Path
        Of the files that belong to it.
    """

    table: Table
    chunk: bytes
    folder: Path

    def n_faces(self) -> dict[str, int]:
        """Return how many triangles each mesh has, where nothing but triangles is listed and the name is its own."""
        counts: dict[str, list[int]] = {}
        for name, primitives in self._meshes():
            is_plain = all(primitive.get("mode", TRIANGLES) == TRIANGLES for primitive in primitives)
            n_corners = (self.table["accessors"][_corners(primitive)]["count"] for primitive in primitives)
            counts.setdefault(name, []).append(sum(count // 3 for count in n_corners) if is_plain else -1)
        return {name: found[0] for name, found in counts.items() if len(found) == 1 and found[0] >= 0}

    def n_not_finite(self) -> dict[str, int]:
        """Return how many points of each mesh are no numbers."""
        return {
            name: sum(map(self._n_bad, {primitive["attributes"]["POSITION"] for primitive in primitives}))
            for name, primitives in self._meshes()
        }

    def _meshes(self) -> Iterator[tuple[str, list[Table]]]:
        """Yield the name of each mesh, and those of its primitives that have points."""
        for number, mesh in enumerate(_rows(self.table, "meshes")):
            primitives = [part for part in _rows(mesh, "primitives") if "POSITION" in _table(part, "attributes")]
            yield mesh.get("name") or f"Mesh_{number}", primitives

    def _n_bad(self, number: int) -> int:
        accessor = self.table["accessors"][number]
        if "bufferView" not in accessor or accessor["componentType"] != FLOAT32:
            return 0
        view = self.table["bufferViews"][accessor["bufferView"]]
        start, stride = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), view.get("byteStride", 12)
        places: NDArray[np.float32] = np.ndarray(
            (accessor["count"], 3), "<f4", self._buffers[view["buffer"]], start, (stride, 4)
        )
        return int((~np.isfinite(places).all(axis=1)).sum())

    @cached_property
    def _buffers(self) -> list[bytes]:
        return [self._buffer(buffer.get("uri")) for buffer in self.table["buffers"]]

    def _buffer(self, uri: str | None) -> bytes:
        if uri is None:
            return self.chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        return (self.folder / unquote(uri)).read_bytes()


def parse_gltf(path: Path) -> GltfFile:
    """Return what a file says of itself.

    Raises
    ------
    Refusal
        If it has not the chunks and files that it should have, or these are not what they say.
    """
    text, chunk, where = path.read_bytes(), b"", ""
    if path.suffix.lower() == ".glb":
        (text, chunk), where = _json_and_binary(text), "chunk JSON, "
    table = _parsed(text, where)
    _check_tables(table, path.parent, len(chunk))
    return GltfFile(table, chunk, path.parent)


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


def _check_tables(table: Table, folder: Path, n_binary: int) -> None:
    """Raise a Refusal if buffers, views and accessors do not lie within each other."""
    buffers = [_buffer_size(buffer, number, folder, n_binary) for number, buffer in enumerate(_rows(table, "buffers"))]
    views = [_view_size(view, number, buffers) for number, view in enumerate(_rows(table, "bufferViews"))]
    for number, accessor in enumerate(_rows(table, "accessors")):
        _check_accessor(accessor, number, _rows(table, "bufferViews"), views)
    for number, mesh in enumerate(_rows(table, "meshes")):
        for primitive in _rows(mesh, "primitives"):
            used = [*_table(primitive, "attributes").values(), primitive.get("indices", 0)]
            if not all(_is_index(accessor, len(_rows(table, "accessors"))) for accessor in used):
                raise damaged(f"meshes[{number}]: it uses an accessor that is not there")


def _rows(table: Table, name: str) -> list[Table]:
    rows = table.get(name, [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise damaged(f'"{name}" is not a list of tables')
    return rows


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


def _buffer_size(buffer: Table, number: int, folder: Path, n_binary: int) -> int:
    """Return how many bytes a buffer says it has; those that are there are not fewer."""
    where = f"buffers[{number}]"
    size = _number(buffer, "byteLength", where)
    # An encoded buffer is decoded by Blender alone; four characters hold three bytes.
    there = n_binary
    if "uri" in buffer:
        uri = buffer["uri"]
        if not isinstance(uri, str) or "\0" in uri:
            raise damaged(f"{where}: it names no file")
        there = len(uri) * 3 // 4 if uri.startswith("data:") else _size_of_file(folder, unquote(uri), where)
    if there < size:
        raise cut_short(f"{where}: {there} of {size} bytes are there")
    return size


def _size_of_file(folder: Path, name: str, where: str) -> int:
    path = folder / name
    if len(name) > LONGEST_NAME or "\0" in name or not path.is_file():
        raise damaged(f'{where}: there is no file "{name[:80]}" beside it')
    return path.stat().st_size


def _view_size(view: Table, number: int, buffers: list[int]) -> int:
    where = f"bufferViews[{number}]"
    size, offset = _number(view, "byteLength", where), _number(view, "byteOffset", where, 0)
    buffer = view.get("buffer")
    # Extensions have buffers that are not there until they are decoded.
    if not _is_index(buffer, len(buffers)) or offset + size > buffers[int(str(buffer))]:
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


def _corners(primitive: Table) -> int:
    """Return the accessor whose count is that of the corners."""
    number: int = primitive.get("indices", primitive["attributes"]["POSITION"])
    return number
