"""The Object File Format: vertices and polygons as text, with a colour for each polygon when written."""

from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ..operators.blender.known_values import mesh_of, present, values_of
from ..operators.mesh_data.mesh_arrays import read_own_integers
from ..operators.mesh_state.state import is_analyzed, read
from ..operators.messages.user_errors import Refusal
from ..operators.outputs.division import PART


def read_off(path: Path) -> None:
    """Add the mesh of a file to the scene."""
    try:
        vertices, polygons = parse_off(path.read_text())
    except (ValueError, IndexError, UnicodeDecodeError) as error:
        raise Refusal("this is not a readable .off file.") from error
    mesh = bpy.data.meshes.new(path.stem)
    mesh.from_pydata(vertices, [], polygons)
    mesh.validate()
    present(bpy.context.collection).objects.link(bpy.data.objects.new(path.stem, mesh))


def parse_off(text: str) -> tuple[list[list[float]], list[list[int]]]:
    """Return the positions and the polygons; what stands behind them on a line, such as colours, is left out."""
    lines = [line for line in (raw.partition("#")[0].split() for raw in text.splitlines()) if line]
    keyword = lines[0].pop(0)
    if not keyword.endswith("OFF"):
        raise ValueError(keyword)
    lines = lines if lines[0] else lines[1:]
    n_vertices, n_polygons = int(lines[0][0]), int(lines[0][1])
    rows = lines[1:]
    if len(rows) < n_vertices + n_polygons:
        raise ValueError("the file ends too early")
    vertices = [[float(number) for number in row[:3]] for row in rows[:n_vertices]]
    polygons = [
        [int(index) for index in row[1 : 1 + int(row[0])]] for row in rows[n_vertices : n_vertices + n_polygons]
    ]
    if any(len(vertex) < 3 for vertex in vertices) or any(
        not 0 <= i < n_vertices for polygon in polygons for i in polygon
    ):
        raise ValueError("a vertex is missing")
    return vertices, [polygon for polygon in polygons if len(polygon) >= 3]


def write_off(path: Path) -> None:
    """Write the meshes of the scene as one, each polygon in the colour of its part."""
    vertices: list[str] = []
    polygons: list[str] = []
    for obj in (obj for obj in bpy.data.objects if obj.type == "MESH"):
        labels = _labels(mesh_of(obj))
        colours = _bytes_of_labels(mesh_of(obj), int(labels.max(initial=0)) + 1)
        for polygon, label in zip(mesh_of(obj).polygons, labels.tolist(), strict=True):
            corners = " ".join(str(len(vertices) + index) for index in values_of(polygon.vertices))
            polygons.append(f"{polygon.loop_total} {corners} {colours[label]}")
        positions = (obj.matrix_world @ vertex.co for vertex in mesh_of(obj).vertices)
        vertices += [f"{place.x:.9g} {place.y:.9g} {place.z:.9g}" for place in positions]
    path.write_text("\n".join(["OFF", f"{len(vertices)} {len(polygons)} 0", *vertices, *polygons]) + "\n")


def _labels(mesh: bpy.types.Mesh) -> NDArray[np.int32]:
    """Return the part of each face; all body where the mesh is not divided."""
    divided = is_analyzed(mesh) and PART.name in mesh.attributes
    return read_own_integers(mesh, PART) if divided else np.zeros(len(mesh.polygons), dtype=np.int32)


def _bytes_of_labels(mesh: bpy.types.Mesh, n_labels: int) -> list[str]:
    """Return the colour of each label as the format wants it, "230 159 0"."""
    linear = read(mesh).parts.colours_of(n_labels)[:, :3]
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return [" ".join(map(str, row)) for row in np.rint(255 * srgb).astype(int).tolist()]
