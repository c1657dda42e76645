"""The part of a mesh that is analyzed, clean, with the analyzed triangle for every triangle of the input."""

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial import cKDTree

from ..choices import SHELLS
from ..errors import MeshError
from .bridging import bridge_shells, large_shells
from .mesh import Bools, Ints, TriangleMesh, connected_pieces

# Edges shorter than this are collapsed; in units of the root of the mean area of a triangle.
SHORTEST_EDGE = 1e-6


@dataclass(frozen=True, eq=False)
class Surface:
    """The part of an input mesh that is analyzed, welded and without collapsed or repeated triangles.

    Attributes
    ----------
    mesh : TriangleMesh
        All V vertices of the input, so that indices stay; only the T' triangles that are analyzed.
    vertex_of_input : (V,) int64
        The vertex that stands for each input vertex: itself, or the first of its doubles.
    input_triangle : (T',) int64
        The input triangle that each analyzed triangle is or, if it bridges two shells, stands on.
    triangle_of_input : (T,) int64
        The analyzed triangle that each input triangle is, repeats or, if it is not analyzed, lies nearest to.
    n_components : int
        Components of the input after welding.
    n_joined : int
        Number of those that are analyzed.
    is_apart : bool
        Whether these are analyzed each by itself; otherwise the surface is connected.
    n_left_out : int
        Triangles of the input that have collapsed or repeat others.
    faceless : (n,) int64
        Vertices of the input that no triangle of it has.
    """

    mesh: TriangleMesh
    vertex_of_input: Ints
    input_triangle: Ints
    triangle_of_input: Ints
    n_components: int
    n_joined: int = 1
    is_apart: bool = False
    n_left_out: int = 0
    faceless: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int64))


def clean_surface(mesh: TriangleMesh, component: int | None = None) -> Surface:
    """Return one component of a mesh in a state that can be analyzed.

    Doubled vertices are welded where the mesh is open, so that seams and triangle soups hold together while closed
    shells that merely touch stay apart; the ends of edges without length are welded everywhere. Triangles that lose a
    corner by it and repeated triangles are left out. Zero-area triangles between three places stay: taking them out
    would tear the surface.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh.
    component : int, optional
        Number of the component after welding, by falling area; the largest if None.

    Raises
    ------
    MeshError
        If there is no such component, or it has no two triangles.
    """
    welded = _weld(mesh)
    label = welded.mesh.component_of_triangle
    return _surface_of(mesh, welded, label == _checked(component, int(label.max()) + 1))


def bridged_surface(mesh: TriangleMesh) -> Surface:
    """Return the largest component together with the shells that prolong it, in a state that can be analyzed.

    Where shells nearly touch, triangles of our own hold them together; see `bridge_shells`. The rest is as in
    `clean_surface`.

    Raises
    ------
    MeshError
        If the mesh has no component of two triangles.
    """
    welded = _weld(mesh)
    label = welded.mesh.component_of_triangle
    bridges = bridge_shells(welded.mesh) if label.any() else None
    is_chosen = label == 0 if bridges is None else bridges.is_joined[label]
    surface = _surface_of(mesh, welded, is_chosen)
    if bridges is None or not len(bridges.triangles):
        return surface
    triangles = np.vstack([surface.mesh.triangles, bridges.triangles])
    origin = np.append(surface.input_triangle, welded.input_triangle[bridges.pier])
    n_joined = int(bridges.is_joined.sum())
    return replace(surface, mesh=TriangleMesh(mesh.vertices, triangles), input_triangle=origin, n_joined=n_joined)


def separate_surface(mesh: TriangleMesh) -> Surface:
    """Return all components that are no details, for an analysis of each by itself; one alone is as in `clean_surface`.

    Raises
    ------
    MeshError
        If the mesh has no component of two triangles.
    """
    welded = _weld(mesh)
    is_large = large_shells(welded.mesh)
    surface = _surface_of(mesh, welded, is_large[welded.mesh.component_of_triangle])
    n_shells = int(is_large.sum())
    return replace(surface, n_joined=n_shells, is_apart=n_shells > 1)


def welded_vertices(mesh: TriangleMesh) -> Ints:
    """Return (V,) the vertex that stands for each where several lie at one place, as they do along seams."""
    return _weld(mesh).vertex_of_input


@dataclass(frozen=True, eq=False)
class _Welded:
    """All components of an input, welded and without collapsed or repeated triangles.

    Attributes
    ----------
    mesh : TriangleMesh
        T" triangles over the vertices of the input.
    vertex_of_input : (V,) int64
    input_triangle : (T",) int64
    twin : (T,) int64
        The first input triangle with the same corners, or -1 for collapsed ones.
    """

    mesh: TriangleMesh
    vertex_of_input: Ints
    input_triangle: Ints
    twin: Ints


def _weld(mesh: TriangleMesh) -> _Welded:
    vertex_of_input = _contract_short_edges(mesh, _weld_open_doubles(mesh))
    corners = vertex_of_input[mesh.triangles]
    twin = _first_twin(corners, len(mesh.vertices))
    kept = np.flatnonzero(twin == np.arange(len(twin)))
    # A mesh that stays as it is keeps what it knows of itself, such as its edges.
    is_same = len(kept) == len(twin) and np.array_equal(corners, mesh.triangles)
    welded = mesh if is_same else TriangleMesh(mesh.vertices, corners[kept])
    return _Welded(welded, vertex_of_input, kept, twin)


def _surface_of(mesh: TriangleMesh, welded: _Welded, is_chosen: Bools) -> Surface:
    chosen = welded.input_triangle[is_chosen]
    if len(chosen) < 2:
        raise MeshError(
            "The largest connected piece of the mesh is a single triangle; merge the vertices of the faces first."
        )
    surface = welded.mesh
    if not is_chosen.all():
        surface = TriangleMesh(mesh.vertices, welded.mesh.triangles[is_chosen])
    n_components = int(welded.mesh.component_of_triangle.max()) + 1
    nearest = _nearest_chosen(mesh, welded.twin, chosen)
    return Surface(
        mesh=surface,
        vertex_of_input=welded.vertex_of_input,
        input_triangle=chosen,
        triangle_of_input=nearest,
        n_components=n_components,
        n_left_out=len(welded.twin) - len(welded.input_triangle),
        faceless=np.setdiff1d(np.arange(len(mesh.vertices)), mesh.used, assume_unique=True),
    )


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


def _contract_short_edges(mesh: TriangleMesh, vertex_of_input: Ints) -> Ints:
    """Weld the ends of edges without length: what hangs on collapsed faces alone would not hang together."""
    ends = vertex_of_input[mesh.edges.vertices].T
    shortest = SHORTEST_EDGE * np.sqrt(mesh.areas.mean())
    is_short = np.ones(ends.shape[1], dtype=bool)
    # One coordinate at a time is several times as fast as rows of three.
    for place in mesh.vertices.T:
        tails, heads = place[ends]
        is_short &= np.abs(heads - tails) <= shortest
    tails, heads = ends[:, is_short]
    if not len(tails):
        return vertex_of_input
    n_vertices = len(vertex_of_input)
    _, first, piece = np.unique(connected_pieces(tails, heads, n_vertices), return_index=True, return_inverse=True)
    return first[piece.reshape(-1)][vertex_of_input]


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


_SURFACE_OF = dict(zip(SHELLS, (bridged_surface, clean_surface, separate_surface), strict=True))


def analyzed_surface(mesh: TriangleMesh, shells: str) -> Surface:
    """Return the analyzed part of a mesh if its shells are "bridged", the "largest" is taken or all are "separate".

    Raises
    ------
    MeshError
        If there is no such choice, or nothing that can be analyzed.
    """
    if shells not in SHELLS:
        raise MeshError(f'Loose parts are "bridged", the "largest" is taken or they are "separate", not "{shells}".')
    return _SURFACE_OF[shells](mesh)
