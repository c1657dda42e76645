"""The faces of a mesh as they were analyzed: their graph, and the field over them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import bpy

from ... import compute
from ..mesh_data.mesh_arrays import MeshArrays, read_mesh
from .stored_analysis import vertex_heights


@dataclass(frozen=True, eq=False)
class AnalyzedFaces:
    """The faces of a mesh, analyzed with one of the choices for loose parts.

    Attributes
    ----------
    mesh : Mesh
    shells : str
    """

    mesh: bpy.types.Mesh
    shells: str

    @cached_property
    def graph(self) -> compute.FaceGraph:
        """The graph of the faces that meet."""
        return compute.face_graph(self._triangles, self._surface, self._arrays.polygon_of_triangle)

    @cached_property
    def relief(self) -> compute.Relief:
        """The field over the faces."""
        polygons, heights = self._arrays.polygon_of_triangle, vertex_heights(self.mesh)
        return compute.relief_of(self._surface, heights, polygons, self.graph.stands_for)

    @cached_property
    def _arrays(self) -> MeshArrays:
        return read_mesh(self.mesh)

    @cached_property
    def _triangles(self) -> compute.TriangleMesh:
        return compute.TriangleMesh(self._arrays.vertices, self._arrays.triangles)

    @cached_property
    def _surface(self) -> compute.Surface:
        return compute.analyzed_surface(self._triangles, self.shells)
