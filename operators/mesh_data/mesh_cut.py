"""Cut polygons along borders: edges are split where a border crosses them, polygons between two such places.

Everything a mesh carries (UVs, weights, colours, shape keys, attributes of any kind) is interpolated along the edges by
Blender itself; polygons that no border crosses are not touched.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_shape import Stretch

# Crossings of one edge that are nearer to each other than this fraction of it are one vertex: no slivers.
SAME_PLACE = 0.05

Ints = NDArray[np.int64]
Arcs = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class CutFaces:
    """The faces that borders ran through or along.

    Attributes
    ----------
    face : (n,) int64
        Their numbers after the cut; new faces are numbered on from the old ones.
    arcs : (n, trees) int64
        What each lies on, for each tree.
    origin : (m,) int64
        The face each new one was cut from.
    """

    face: Ints
    arcs: Ints
    origin: Ints


def cut_mesh(mesh: bpy.types.Mesh, crossings: compute.Crossings, arc_of_vertex: Ints, stretch: Stretch) -> CutFaces:
    """Insert borders into a mesh.

    Parameters
    ----------
    crossings : Crossings
        Of the edges of the mesh.
    arc_of_vertex : (V, trees) int64
    stretch : Stretch
        From the mesh to the shape that the borders were found on.
    """
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        cut = _Cut(edited, crossings, arc_of_vertex, stretch)
        cut.split_edges()
        cut.split_faces()
        faces = cut.faces()
        edited.to_mesh(mesh)
    finally:
        edited.free()
    return faces


class _Cut:
    """A mesh while it is cut."""

    def __init__(
        self, edited: bmesh.types.BMesh, crossings: compute.Crossings, arc_of_vertex: Ints, stretch: Stretch
    ) -> None:
        for elements in (edited.verts, edited.edges, edited.faces):
            elements.ensure_lookup_table()
        self._n_faces = len(edited.faces)
        self._edited = edited
        self._parameter = crossings.snapped().tolist()
        self._is_entry = crossings.is_entry.tolist()
        self._border = crossings.border.tolist()
        self._arcs_behind = [tuple(arcs) for arcs in crossings.arcs.tolist()]
        self._arcs_of_vertex = arc_of_vertex
        self._stretch = stretch
        self._edges = {edge: edited.edges[edge] for edge in np.unique(crossings.edge).tolist()}
        starts = np.searchsorted(crossings.edge, list(self._edges)).tolist()
        self._rows = dict(zip(self._edges, map(range, starts, [*starts[1:], len(crossings.edge)]), strict=False))
        self._crossed = list(dict.fromkeys(face for edge in self._edges.values() for face in edge.link_faces))
        # The way around each polygon, before anything is split: its edges, and whether they are run backwards.
        self._outlines = [
            [(loop.edge.index, loop.vert is not loop.edge.verts[0]) for loop in face.loops] for face in self._crossed
        ]
        self._vertex_of_row: dict[int, bmesh.types.BMVert] = {}
        self._vertices_of_edge: dict[int, set[bmesh.types.BMVert]] = {}
        self._arcs_of_piece: dict[bmesh.types.BMEdge, Arcs] = {}
        self._pieces = [[face] for face in self._crossed]

    def split_edges(self) -> None:
        """Put a vertex on every crossing, and remember what each piece of an edge lies on."""
        for number, edge in self._edges.items():
            ends = set(edge.verts)
            self._split_edge(edge, self._rows[number])
            self._vertices_of_edge[number] = ends.union(self._vertex_of_row[row] for row in self._rows[number])

    def split_faces(self) -> None:
        """Join the crossings of each border through the polygons."""
        for pieces, outline in zip(self._pieces, self._outlines, strict=True):
            for start, stop in self._chords(outline):
                ends = {self._vertex_of_row[start], self._vertex_of_row[stop]}
                # A border that was snapped to an edge from both sides runs along it.
                if not any(ends <= self._vertices_of_edge.get(edge, set()) for edge, _ in outline):
                    _split_between(pieces, ends)

    def faces(self) -> CutFaces:
        """Return what was cut."""
        self._edited.faces.index_update()
        arcs = {face: self._arcs_of_face(face) for pieces in self._pieces for face in pieces}
        # A piece between borders alone, in a corner where three parts meet, stays what its polygon was.
        bordered = [face for face in arcs if arcs[face]]
        origin = {piece.index: pieces[0].index for pieces in self._pieces for piece in pieces[1:]}
        return CutFaces(
            np.array([face.index for face in bordered], dtype=np.int64),
            np.array([arcs[face] for face in bordered], dtype=np.int64).reshape(
                len(bordered), self._arcs_of_vertex.shape[1]
            ),
            np.array([origin[face] for face in range(self._n_faces, len(self._edited.faces))], dtype=np.int64),
        )

    def _split_edge(self, edge: bmesh.types.BMEdge, rows: range) -> None:
        first, last = edge.verts
        reached, arcs, done = first, self._arcs_at(first), 0.0
        for row in rows:
            parameter = self._parameter[row]
            if parameter == 1.0:
                self._vertex_of_row[row] = last
                continue
            if parameter > done + SAME_PLACE:
                behind, vertex = bmesh.utils.edge_split(edge, reached, (parameter - done) / (1 - done))
                edge, passed = (behind, edge) if reached in edge.verts else (edge, behind)
                self._arcs_of_piece[passed] = arcs
                reached, done = vertex, parameter
            self._vertex_of_row[row] = reached
            arcs = self._arcs_behind[row]
        # Where the last crossings are on the far vertex itself, this piece lies before them.
        reaches_end = self._parameter[rows[-1]] < 1.0
        self._arcs_of_piece[edge] = self._arcs_at(last) if reaches_end else arcs

    def _chords(self, outline: list[tuple[int, bool]]) -> Iterator[tuple[int, int]]:
        """Yield the pairs of crossings between which a border runs through a polygon: in, and out again."""
        by_border: dict[int, list[tuple[int, bool]]] = {}
        for edge, is_backward in outline:
            rows = self._rows.get(edge, range(0))
            for row in reversed(rows) if is_backward else rows:
                by_border.setdefault(self._border[row], []).append((row, self._is_entry[row] != is_backward))
        for passages in by_border.values():
            for place, (row, enters) in enumerate(passages):
                if enters:
                    yield row, passages[(place + 1) % len(passages)][0]

    def _arcs_at(self, vertex: bmesh.types.BMVert) -> Arcs:
        return tuple(self._arcs_of_vertex[vertex.index].tolist())

    def _arcs_of_face(self, face: bmesh.types.BMFace) -> Arcs:
        """Return the arcs that most of a face's outline lies on, none if it consists of borders inside the polygon."""
        # Blender gives no number to what was made during the cut.
        lengths: defaultdict[Arcs, float] = defaultdict(float)
        for edge in face.edges:
            if edge in self._arcs_of_piece:
                lengths[self._arcs_of_piece[edge]] += self._length(edge)
            elif edge.index >= 0:
                lengths[self._arcs_at(edge.verts[0])] += self._length(edge)
        return max(lengths, key=lengths.__getitem__, default=())

    def _length(self, edge: bmesh.types.BMEdge) -> float:
        if self._stretch.is_none:
            return edge.calc_length()
        start, end = edge.verts
        return float(np.linalg.norm(self._stretch.of(np.array([end.co - start.co]))))


def _split_between(pieces: list[bmesh.types.BMFace], ends: set[bmesh.types.BMVert]) -> None:
    """Split the piece of a polygon that has both vertices, unless an edge joins them."""
    start, stop = ends
    if any(stop in edge.verts for edge in start.link_edges):
        return
    face = next((piece for piece in pieces if start in piece.verts and stop in piece.verts), None)
    if face is not None:
        new, _ = bmesh.utils.face_split(face, start, stop)
        pieces.append(new)
