"""The Polygon File Format; results have the part of each face in it, beside what Blender writes of the vertices."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...operators.blender.known_values import elements_of, mesh_of
from ...operators.mesh_data.mesh_arrays import n_corners_of_polygon, own_names, read_own_integers
from ...operators.mesh_state.state import is_analyzed
from ...operators.outputs.division import PART
from ..results.stages import write_surely
from .open_file import OpenFile, open_file
from .own_attributes import claim_own_attributes
from .ply_file import Header, header_of, parse_ply
from .repairs import mended

# How Blender writes the corners of faces, and what stands behind them in our results.
CORNERS, OUR_PART = "property list uchar uint vertex_indices\n", "property int part\n"
# In the head of results whose colours are those of parts and nobody else's.
OUR_COLOURS = "comment Colors are those of the parts, by Eigenparts\n"


def read_ply(path: Path) -> OpenFile:
    """Open a file, with the parts of its faces if it is a result of ours."""
    data = path.read_bytes()
    header, not_finite = parse_ply(data)
    bpy.ops.wm.ply_import(filepath=str(path))
    # Blender has put points that are no numbers at the origin.
    repairs = mended(header.count_of("face"), not_finite)
    for mesh in bpy.data.meshes:
        _take_back_parts(mesh, header, data)
    return open_file(claim_own_attributes(repairs))


def write_ply(path: Path, file: OpenFile) -> None:
    """Write the mesh that was read, with its own colours, or those of the parts if it had none."""
    mesh = mesh_of(file.objects[0])
    users = [name for name in mesh.color_attributes.keys() if name not in own_names(mesh)]  # noqa: SIM118
    if users:
        mesh.color_attributes.active_color_name = users[0]
    export = partial(bpy.ops.wm.ply_export, export_colors="SRGB", export_attributes=True, check_existing=False)
    write_surely(lambda: export(filepath=str(path)), path)
    if is_analyzed(mesh) and PART.name in mesh.attributes:
        _add_parts(path, mesh, "" if users else OUR_COLOURS)


def _take_back_parts(mesh: bpy.types.Mesh, header: Header, data: bytes) -> None:
    """Give a mesh the parts of its faces if the file is a result of ours."""
    if OUR_COLOURS in header.text:
        for name in mesh.color_attributes.keys():  # noqa: SIM118
            mesh.attributes.remove(mesh.attributes[name])
    is_label = _bytes_of_labels(mesh)
    values = np.frombuffer(data, np.uint8)[_start_of_faces(header) :]
    if _fits(header, mesh) and CORNERS + OUR_PART in header.text and len(is_label) <= len(values):
        labels = values[: len(is_label)][is_label].view("<i4").astype(np.int32)
        elements_of(mesh.attributes.new(PART.name, "INT", "FACE")).foreach_set("value", labels)


def _add_parts(path: Path, mesh: bpy.types.Mesh, comment: str) -> None:
    """Add the part of each face to a file, which Blender leaves out."""
    data = path.read_bytes()
    header, is_label = header_of(data), _bytes_of_labels(mesh)
    if not _fits(header, mesh):
        return
    start = _start_of_faces(header)
    values = np.frombuffer(data, np.uint8)[start:]
    faces = np.empty(len(is_label), dtype=np.uint8)
    n_before = len(is_label) - int(is_label.sum())
    faces[is_label] = read_own_integers(mesh, PART).astype("<i4").view(np.uint8)
    faces[~is_label] = values[:n_before]
    text = header.text.replace(CORNERS, CORNERS + OUR_PART).replace("element vertex", f"{comment}element vertex", 1)
    path.write_bytes(text.encode("latin-1") + data[header.size : start] + faces.tobytes() + values[n_before:].tobytes())


def _fits(header: Header, mesh: bpy.types.Mesh) -> bool:
    """Whether a file begins as Blender writes it, with the points and then the faces of a mesh."""
    names = [element.name for element in header.elements[:2]]
    is_usual = header.order == "<" and names == ["vertex", "face"] and not header.elements[0].has_lists
    return is_usual and CORNERS in header.text and header.elements[1].count == len(mesh.polygons)


def _start_of_faces(header: Header) -> int:
    return header.size + header.elements[0].count * header.elements[0].row_type(header.order).itemsize


def _bytes_of_labels(mesh: bpy.types.Mesh) -> NDArray[np.bool_]:
    """Return which bytes of the faces of a result are labels: one byte, four for each corner, four of a label."""
    ends = np.cumsum(1 + 4 * n_corners_of_polygon(mesh) + 4)
    is_label = np.zeros(int(ends[-1]) if len(ends) else 0, dtype=bool)
    is_label[(ends[:, None] - 4 + np.arange(4)).ravel()] = True
    return is_label
