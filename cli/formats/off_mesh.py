"""Meshes of .off files: every face keeps its line, also those that Blender cannot hold."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray

from ...operators.blender.known_values import elements_of, mesh_of, present
from ...operators.mesh_data.mesh_arrays import (
    n_corners_of_polygon,
    read_own_integers,
    read_positions,
    vertex_of_corner,
)
from ...operators.mesh_state.palette import srgb_of
from ...operators.mesh_state.state import is_analyzed, read
from ...operators.outputs.division import PART
from ...operators.outputs.vertex_map import labels_of_vertices
from .off import FaceLines, OffFile, parse_off
from .open_file import OpenFile, open_file
from .repairs import MOVED, move_to_neighbours

LEFT_OUT = (
    "Faces that cannot be divided: {} of {}; they have fewer than 3 corners, repeat a corner or another face, or name"
    " points that do not exist. Their lines in the result have the color of the same face or of what is around them."
)
UNREAD = "{} lines behind the last face, from line {} on, were not read: the head counts fewer faces."
UNREAD_LINE = "1 line behind the last face, line {}, was not read: the head counts fewer faces."
# While the mesh is made: the line of the file that each face comes from.
LINE = "line of the file"


def read_off(path: Path) -> OpenFile:
    """Open a file, with the lines of its faces."""
    file = parse_off(path.read_bytes())
    mesh = bpy.data.meshes.new(path.stem)
    lines = _fill(mesh, file)
    # Before Blender puts them at the origin.
    n_moved = move_to_neighbours(mesh)
    kept, n_faces = _validated(mesh, lines), len(file.n_corners)
    present(bpy.context.collection).objects.link(bpy.data.objects.new(path.stem, mesh))
    told = [MOVED.format(n_moved)] if n_moved else []
    told += [LEFT_OUT.format(n_faces - len(kept), n_faces)] if len(kept) < n_faces else []
    told += _told_of_unread(file.unread)
    return open_file({mesh.name: told}, FaceLines(file.n_corners, file.corners, kept))


def write_off(path: Path, file: OpenFile) -> None:
    """Write the mesh that was read, each line of a face with the colour of its part behind it."""
    mesh = mesh_of(file.objects[0])
    lines = file.face_lines or _lines_of(mesh)
    labels = _labels_of_lines(mesh, lines)
    colours = _bytes_of_labels(mesh, int(labels.max(initial=0)) + 1)
    # One text with places for all numbers is filled in much faster than a text for each line.
    layouts = {size: f"{size}{' %d' * size} " for size in np.unique(lines.n_corners).tolist()}
    faces = (
        layouts[size] + colours[label] for size, label in zip(lines.n_corners.tolist(), labels.tolist(), strict=True)
    )
    text = "\n".join(
        ["OFF", f"{len(mesh.vertices)} {len(labels)} 0", *["%.9g %.9g %.9g"] * len(mesh.vertices), *faces, ""]
    )
    path.write_text(text % (*read_positions(mesh).ravel().tolist(), *lines.corners.tolist()), encoding="ascii")


def _told_of_unread(lines: list[int]) -> list[str]:
    """Return the sentence about the lines behind the last face, if there are any."""
    if len(lines) == 1:
        return [UNREAD_LINE.format(lines[0])]
    return [UNREAD.format(len(lines), lines[0])] if lines else []


def _fill(mesh: bpy.types.Mesh, file: OffFile) -> NDArray[np.int64]:
    """Give a new mesh points, and faces whose points exist, and return the lines of these."""
    line_of_corner = np.repeat(np.arange(len(file.n_corners)), file.n_corners)
    is_missing = (file.corners < 0) | (file.corners >= len(file.vertices))
    is_face = (file.n_corners >= 3) & (np.bincount(line_of_corner, is_missing, len(file.n_corners)) == 0)
    n_corners = file.n_corners[is_face]
    mesh.vertices.add(len(file.vertices))
    with np.errstate(over="ignore"):
        mesh.vertices.foreach_set("co", file.vertices.astype(np.float32).ravel())
    mesh.loops.add(int(n_corners.sum()))
    mesh.loops.foreach_set("vertex_index", file.corners[is_face[line_of_corner]].astype(np.int32))
    mesh.polygons.add(len(n_corners))
    mesh.polygons.foreach_set("loop_start", (np.cumsum(n_corners) - n_corners).astype(np.int32))
    mesh.update(calc_edges=True)
    mesh.shade_flat()
    return np.flatnonzero(is_face)


def _validated(mesh: bpy.types.Mesh, lines: NDArray[np.int64]) -> NDArray[np.int64]:
    """Leave out the faces that Blender cannot hold, and return those of the lines that stay."""
    attribute = mesh.attributes.new(LINE, "INT", "FACE")
    elements_of(attribute).foreach_set("value", lines.astype(np.int32))
    mesh.validate()
    kept = np.empty(len(mesh.polygons), dtype=np.int32)
    elements_of(mesh.attributes[LINE]).foreach_get("value", kept)
    mesh.attributes.remove(mesh.attributes[LINE])
    return kept.astype(np.int64)


def _lines_of(mesh: bpy.types.Mesh) -> FaceLines:
    """Return a line for each face of a mesh that was not read from an .off file."""
    corners = vertex_of_corner(mesh).astype(np.int64)
    return FaceLines(n_corners_of_polygon(mesh), corners, np.arange(len(mesh.polygons)))


def _labels_of_lines(mesh: bpy.types.Mesh, lines: FaceLines) -> NDArray[np.int32]:
    """Return the part of each line; of those that are no faces, that of the same face or around their first point."""
    labels = np.zeros(len(lines.n_corners), dtype=np.int32)
    if is_analyzed(mesh) and PART.name in mesh.attributes:
        of_faces, first = read_own_integers(mesh, PART), lines.first_corner
        exists = (first >= 0) & (first < len(mesh.vertices))
        labels[exists] = labels_of_vertices(mesh, of_faces)[first[exists]]
        labels[lines.kept] = of_faces
        _give_repeats_the_same(labels, lines)
    return labels


def _give_repeats_the_same(labels: NDArray[np.int32], lines: FaceLines) -> None:
    repeats = np.setdiff1d(np.arange(len(labels)), lines.kept).tolist()
    if repeats:
        corners = [frozenset(row.tolist()) for row in np.split(lines.corners, np.cumsum(lines.n_corners)[:-1])]
        label_of = {corners[line]: labels[line] for line in lines.kept.tolist()}
        for line in repeats:
            labels[line] = label_of.get(corners[line], labels[line])


def _bytes_of_labels(mesh: bpy.types.Mesh, n_labels: int) -> list[str]:
    """Return the colour of each label as the format wants it, "230 159 0"."""
    linear = read(mesh).parts.colours_of(n_labels)[:, :3]
    return [" ".join(map(str, row)) for row in np.rint(255 * srgb_of(linear)).astype(int).tolist()]
