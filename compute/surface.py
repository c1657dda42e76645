"""The part of a mesh that is analyzed: one clean component, and the way back to every triangle of the input."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from .errors import MeshError
from .mesh import Ints, TriangleMesh


@dataclass(frozen=True, eq=False)
class Surface:
    """One connected component of an input mesh, welded and without collapsed or repeated triangles.

    Attributes
    ----------
    mesh : TriangleMesh
        All V vertices of the input, so that indices stay; only the T' triangles that are analyzed.
    vertex_of_input : (V,) int64
        The vertex that stands for each input vertex: itself, or the first of its doubles.
    input_triangle : (T',) int64
        The input triangle that each analyzed triangle is.
    triangle_of_input : (T,) int64
        The analyzed triangle that each input triangle is, repeats or, if it is not analyzed, lies nearest to.
    n_components : int
        Components of the input after welding.
    """

    mesh: TriangleMesh
    vertex_of_input: Ints
    input_triangle: Ints
    triangle_of_input: Ints
    n_components: int


def clean_surface(mesh: TriangleMesh, component: int | None = None) -> Surface:
    """Return one component of a mesh in a state that can be analyzed.

    Doubled vertices are welded where the mesh is open, so that seams and triangle soups hold together while closed
    shells that merely touch stay apart. Triangles that lose a corner by it and repeated triangles are left out.
    Zero-area triangles with three different corners stay: taking them out would tear the surface.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    component : int, optional
        Which component after welding, by falling area; the largest if None.

    Raises
    ------
    MeshError
        If there is no such component, or it has no two triangles.
    """
    vertex_of_input = _weld_open_doubles(mesh)
    corners = vertex_of_input[mesh.triangles]
    twin = _first_twin(corners, len(mesh.vertices))
    kept = np.flatnonzero(twin == np.arange(len(twin)))
    welded = TriangleMesh(mesh.vertices, corners[kept])
    label = welded.component_of_triangle
    n_components = int(label.max()) + 1
    chosen = kept[label == _checked(component, n_components)]
    if len(chosen) < 2:
        raise MeshError(
            "The largest connected piece of the mesh is a single triangle; merge the vertices of the faces first."
        )
    surface = TriangleMesh(mesh.vertices, corners[chosen])
    return Surface(surface, vertex_of_input, chosen, _nearest_chosen(mesh, twin, chosen), n_components)


def _checked(component: int | None, n_components: int) -> int:
    if component is None:
        return 0
    if not 0 <= component < n_components:
        raise MeshError(f"Component {component} does not exist; the mesh has components 0 to {n_components - 1}.")
    return component


def _weld_open_doubles(mesh: TriangleMesh) -> Ints:
    """Return for each vertex the first one at exactly its place, among those on open edges."""
    vertex = np.arange(len(mesh.vertices))
    edges = mesh.edges
    on_boundary = np.unique(edges.vertices[edges.n_triangles == 1])
    if len(on_boundary):
        # Adding zero turns -0.0 into 0.0, which np.unique would tell apart.
        _, first, place = np.unique(mesh.vertices[on_boundary] + 0.0, axis=0, return_index=True, return_inverse=True)
        vertex[on_boundary] = on_boundary[first[place.reshape(-1)]]
    return vertex


def _first_twin(corners: Ints, n_vertices: int) -> Ints:
    """Return for each triangle the first one with the same corners in any order; -1 where two corners coincide."""
    ordered = np.sort(corners, axis=1)
    _, edge = np.unique(ordered[:, 0] * n_vertices + ordered[:, 1], return_inverse=True)
    _, first, group = np.unique(edge.reshape(-1) * n_vertices + ordered[:, 2], return_index=True, return_inverse=True)
    collapsed = (ordered[:, 0] == ordered[:, 1]) | (ordered[:, 1] == ordered[:, 2])
    return np.where(collapsed, -1, first[group.reshape(-1)])


def _nearest_chosen(mesh: TriangleMesh, twin: Ints, chosen: Ints) -> Ints:
    """Return for each input triangle the place in ``chosen`` of its twin or of the nearest triangle."""
    place = np.full(len(twin) + 1, -1)
    place[chosen] = np.arange(len(chosen))
    nearest = place[twin]
    if (outside := nearest < 0).any():
        centres = mesh.vertices[mesh.triangles].mean(axis=1)
        nearest[outside] = cKDTree(centres[chosen]).query(centres[outside])[1]
    return nearest
