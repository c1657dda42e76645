"""The Polygon File Format; results have the part of each face in it, beside what Blender writes of the vertices."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...operators.blender.known_values import elements_of, mesh_of
from ...operators.mesh_data.mesh_arrays import n_corners_of_polygon, own_names, read_own_integers
from ...operators.mesh_state.state import is_analyzed
from ...operators.outputs.division import PART
from ..atomic_write import write_surely
from .repairs import Repairs, mended

HEAD = re.compile(rb"ply\r?\n.*?end_header\r?\n", re.DOTALL)
ELEMENT = re.compile(r"^element (\w+) (\d+)$|^property (\w+) (\w+)$|^property list .*$", re.MULTILINE)
BYTE_ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">", "ascii": ""}
# How Blender writes the corners of faces, and what stands behind them in our results.
CORNERS, OUR_PART = "property list uchar uint vertex_indices\n", "property int part\n"
# In the head of results whose colours are those of parts and nobody else's.
OUR_COLOURS = "comment Colors are those of the parts, by Eigenparts\n"
TYPES = {
    **dict(char="i1", uchar="u1", short="i2", ushort="u2", int="i4", uint="u4", float="f4", double="f8"),
    **dict(int8="i1", uint8="u1", int16="i2", uint16="u2", int32="i4", uint32="u4", float32="f4", float64="f8"),
}


@dataclass(frozen=True)
class _Head:
    """The head of a file whose vertices come first.

    Attributes
    ----------
    text : str
    order : str
        Of bytes; nothing if the values are text.
    vertex_type : dtype
        The bytes of a vertex.
    n_vertices, n_faces : int
    """

    text: str
    order: str
    vertex_type: np.dtype[np.void]
    n_vertices: int
    n_faces: int

    @property
    def faces_at(self) -> int:
        """Where the faces of a binary file begin."""
        return len(self.text) + self.n_vertices * self.vertex_type.itemsize


def read_ply(path: Path) -> Repairs:
    """Add the mesh of a file to the scene, and return what was mended."""
    data = path.read_bytes()
    head = _head_of(data)
    bpy.ops.wm.ply_import(filepath=str(path))
    if head is None:
        return mended()
    # Blender has put points that are no numbers at the origin.
    repairs = mended(head.n_faces, _not_finite(head, data))
    for mesh in bpy.data.meshes:
        _take_back_parts(mesh, head, data)
    return repairs


def write_ply(path: Path) -> None:
    """Write the mesh that was read, with its own colours, or those of the parts if it had none."""
    mesh = mesh_of(next(obj for obj in bpy.data.objects if obj.type == "MESH"))
    users = [name for name in mesh.color_attributes.keys() if name not in own_names(mesh)]  # noqa: SIM118
    if users:
        mesh.color_attributes.active_color_name = users[0]
    export = partial(bpy.ops.wm.ply_export, export_colors="SRGB", export_attributes=True, check_existing=False)
    write_surely(lambda: export(filepath=str(path)), path)
    if is_analyzed(mesh) and PART.name in mesh.attributes:
        _add_parts(path, mesh, "" if users else OUR_COLOURS)


def _head_of(data: bytes) -> _Head | None:
    """Return the head of a file; None if it is another than usual, so that nothing is known of what it holds."""
    found = HEAD.match(data)
    if found is None:
        return None
    text = found[0].decode("latin-1")
    kinds: dict[str, tuple[int, list[tuple[str, str]]]] = {}
    properties: list[tuple[str, str]] = []
    for name, count, kind, property_name in ELEMENT.findall(text.replace("\r", "")):
        if name:
            kinds[name] = int(count), (properties := [])
        else:
            properties.append((property_name, kind))
    return _understood(text, kinds)


def _understood(text: str, kinds: dict[str, tuple[int, list[tuple[str, str]]]]) -> _Head | None:
    order = BYTE_ORDERS.get(text.split()[2])
    n_vertices, properties = kinds.get("vertex", (0, []))
    is_usual = next(iter(kinds), None) == "vertex" and {"x", "y", "z"} <= {name for name, _ in properties}
    if order is None or not is_usual or not all(kind in TYPES for _, kind in properties):
        return None
    vertex_type = np.dtype([(name, order + TYPES[kind]) for name, kind in properties])
    return _Head(text, order, vertex_type, n_vertices, kinds.get("face", (0, []))[0])


def _not_finite(head: _Head, data: bytes) -> NDArray[np.bool_] | None:
    """Return (V,) which points are no numbers; None if the file does not say so."""
    try:
        if head.order:
            rows = np.frombuffer(data, head.vertex_type, head.n_vertices, len(head.text))
            places = np.stack([rows["x"], rows["y"], rows["z"]], axis=1)
        else:
            columns = tuple(list(head.vertex_type.fields or ()).index(name) for name in "xyz")
            lines = data[len(head.text) :].decode("latin-1").splitlines()[: head.n_vertices]
            places = np.loadtxt(lines, usecols=columns, comments=None, ndmin=2)
    except ValueError:
        return None
    return ~np.isfinite(places).all(axis=1)


def _take_back_parts(mesh: bpy.types.Mesh, head: _Head, data: bytes) -> None:
    """Give a mesh the parts of its faces if the file is a result of ours."""
    if OUR_COLOURS in head.text:
        for name in mesh.color_attributes.keys():  # noqa: SIM118
            mesh.attributes.remove(mesh.attributes[name])
    is_label = _bytes_of_labels(mesh)
    values = np.frombuffer(data, np.uint8)[head.faces_at :]
    if CORNERS + OUR_PART in head.text and len(mesh.polygons) == head.n_faces and len(is_label) <= len(values):
        labels = values[: len(is_label)][is_label].view("<i4").astype(np.int32)
        elements_of(mesh.attributes.new(PART.name, "INT", "FACE")).foreach_set("value", labels)


def _add_parts(path: Path, mesh: bpy.types.Mesh, comment: str) -> None:
    """Add the part of each face to a file, which Blender leaves out."""
    data = path.read_bytes()
    head, is_label = _head_of(data), _bytes_of_labels(mesh)
    if head is None or CORNERS not in head.text or head.n_faces != len(mesh.polygons):
        return
    values = np.frombuffer(data, np.uint8)[head.faces_at :]
    faces = np.empty(len(is_label), dtype=np.uint8)
    n_before = len(is_label) - int(is_label.sum())
    faces[is_label] = read_own_integers(mesh, PART).astype("<i4").view(np.uint8)
    faces[~is_label] = values[:n_before]
    text = head.text.replace(CORNERS, CORNERS + OUR_PART).replace("element vertex", f"{comment}element vertex", 1)
    vertices = data[len(head.text) : head.faces_at]
    path.write_bytes(text.encode("latin-1") + vertices + faces.tobytes() + values[n_before:].tobytes())


def _bytes_of_labels(mesh: bpy.types.Mesh) -> NDArray[np.bool_]:
    """Return which bytes of the faces of a result are labels: one byte, four for each corner, four of a label."""
    ends = np.cumsum(1 + 4 * n_corners_of_polygon(mesh) + 4)
    is_label = np.zeros(int(ends[-1]) if len(ends) else 0, dtype=bool)
    is_label[(ends[:, None] - 4 + np.arange(4)).ravel()] = True
    return is_label
