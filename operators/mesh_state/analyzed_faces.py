"""The faces of a mesh as they were analyzed: their graph, and the field over them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_shape import MeshArrays, Stretch
from ..mesh_data.mesh_arrays import read_mesh
from .stored_analysis import vertex_heights


@dataclass(frozen=True, eq=False)
class AnalyzedFaces:
    """The faces of a mesh, analyzed with one of the choices for loose parts.

    Attributes
    ----------
    mesh : Mesh
    shells : str
    stretch : Stretch
        From the mesh to the shape that was analyzed.
    """

    mesh: bpy.types.Mesh
    shells: str
    stretch: Stretch

    @cached_property
    def graph(self) -> compute.FaceGraph:
        """The graph of the faces that meet."""
        return compute.face_graph(self._triangles, self._surface, self._arrays.polygon_of_triangle)

    @cached_property
    def relief(self) -> compute.Relief:
        """The field over the faces."""
        polygons, heights = self._arrays.polygon_of_triangle, vertex_heights(self.mesh)
        return compute.relief_of(self._surface, heights, polygons, self.graph.stands_for)

    @property
    def place_of_vertex(self) -> NDArray[np.int64]:
        """The (V,) vertex that stands for each where several lie at one place along a seam."""
        return self._surface.vertex_of_input

    @cached_property
    def _arrays(self) -> MeshArrays:
        return read_mesh(self.mesh, self.stretch)

    @cached_property
    def _triangles(self) -> compute.TriangleMesh:
        return compute.TriangleMesh(self._arrays.vertices, self._arrays.triangles)

    @cached_property
    def _surface(self) -> compute.Surface:
        return compute.analyzed_surface(self._triangles, self.shells)
