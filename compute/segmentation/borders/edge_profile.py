"""The field along the edges of the input: what the borders of every level are drawn from."""

from dataclasses import dataclass
from math import isqrt

import numpy as np
from numpy.typing import NDArray

from ...fields.scalar_field import ScalarField
from ...surface.cleaning import Surface
from ...surface.mesh import Bools, Floats, Ints


@dataclass(frozen=True, eq=False)
class EdgeProfile:
    """The field along E edges of an input mesh with V vertices.

    Attributes
    ----------
    edges : (E, 2) int64
        Input vertices.
    heights : (E, m) float64
        The field at m evenly spaced points, from the first vertex to the second; not a number where it is not known.
    arcs : tuple of (V,) int32
        For each tree, the arc that each vertex lies on; -1 where the mesh was not analyzed.
    """

    edges: Ints
    heights: Floats
    arcs: tuple[NDArray[np.int32], ...]


def edge_profile(surface: Surface, field: ScalarField, arc_of_net: tuple[Ints, ...], edges: Ints) -> EdgeProfile:
    """Return the field along edges of the input.

    Parameters
    ----------
    surface : Surface
    field : ScalarField
        Its net has the vertices of the input first, then the nodes inside edges, from the lower vertex to the higher.
    arc_of_net : tuple of (n,) int64
        For each tree, the arc of each vertex of the net.
    edges : (E, 2) int64
        Pairs of input vertices.
    """
    is_analyzed = np.zeros(len(surface.mesh.vertices), dtype=bool)
    is_analyzed[surface.mesh.triangles] = True
    is_analyzed = is_analyzed[surface.vertex_of_input]
    arcs = tuple(np.where(is_analyzed, arc[surface.vertex_of_input], -1).astype(np.int32) for arc in arc_of_net)
    return EdgeProfile(edges, _heights(surface, field, edges, is_analyzed), arcs)


def vertex_heights(surface: Surface, field: ScalarField) -> Floats:
    """Return (V,) the field on the input's vertices, 0 where it was not analyzed."""
    used = np.zeros(len(surface.mesh.vertices), dtype=bool)
    used[surface.mesh.triangles] = True
    return np.where(used, field.values[: len(used)], 0.0)[surface.vertex_of_input]


def _heights(surface: Surface, field: ScalarField, edges: Ints, is_analyzed: Bools) -> Floats:
    order = isqrt(len(field.net.triangles) // len(surface.mesh.triangles))
    ends = surface.vertex_of_input[edges]
    step = np.arange(order + 1) / order
    first, last = field.values[ends].T
    # An edge that welding or cleaning took out runs straight from end to end.
    heights = first[:, None] * (1 - step) + last[:, None] * step
    place, is_known = _find_edges(surface, ends)
    inside = len(surface.mesh.vertices) + (order - 1) * place[is_known, None] + np.arange(order - 1)
    backward = ends[is_known, 0] > ends[is_known, 1]
    inside[backward] = inside[backward][:, ::-1]
    heights[is_known, 1:-1] = field.values[inside]
    heights[~is_analyzed[edges].all(axis=1)] = np.nan
    return heights


def _find_edges(surface: Surface, ends: Ints) -> tuple[Ints, Bools]:
    """Return the edge of the surface that joins each pair of vertices, and whether there is one."""
    n_vertices = len(surface.mesh.vertices)
    known = surface.mesh.edges.vertices[:, 0] * n_vertices + surface.mesh.edges.vertices[:, 1]
    wanted = ends.min(axis=1) * n_vertices + ends.max(axis=1)
    place = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    return place, known[place] == wanted
