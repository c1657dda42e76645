"""Shells that belong together: a character whose limbs are loose parts is bridged where they nearly touch.

And shells that are large enough to be divided each by itself.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from .mesh import Bools, Floats, Ints, TriangleMesh
from .ties import evened

# Shells with less than this part of the area are details: eyes, teeth, buttons.
LEAST_SHARE = 0.004

# Shells are bridged where they come as near as the edges are long there, or as this, in units of the root of the area.
TOUCHING = 0.02

# A shell lies on others when this share of its vertices is as near to them as that, in the same unit.
LYING_SHARE = 0.9
LYING = 0.04


@dataclass(frozen=True, eq=False)
class Bridges:
    """Shells that are analyzed together, and the triangles that hold them together.

    Attributes
    ----------
    is_joined : (S,) bool
        Whether a shell is the largest or prolongs it.
    triangles : (n, 3) int64
        One corner on one shell, two on another.
    pier : (n,) int64
        A triangle of the mesh on which each bridge stands with two corners.
    """

    is_joined: Bools
    triangles: Ints
    pier: Ints


def bridge_shells(mesh: TriangleMesh) -> Bridges:
    """Return bridges from the largest shell of a mesh to those that prolong it, and from these to the next.

    Details and what lies on another shell all along, such as clothes, are left out: they have no shape of their own.
    """
    shell = _shell_of_vertex(mesh)
    area = np.bincount(mesh.component_of_triangle, mesh.areas)
    unit = np.sqrt(area.sum())
    spacing = np.maximum(_mean_edge_length(mesh), TOUCHING * unit)
    is_joined = np.arange(len(area)) == 0
    is_waiting = ~is_joined & (area >= LEAST_SHARE * area.sum())
    feet, heads = [], []
    while is_waiting.any():
        known, asking = np.flatnonzero(_chosen(is_joined, shell)), np.flatnonzero(_chosen(is_waiting, shell))
        distance, place = cKDTree(mesh.vertices[known]).query(mesh.vertices[asking])
        nearest = known[place]
        is_near = distance <= np.maximum(spacing[asking], spacing[nearest])
        n_vertices, n_lying, n_near = (
            np.bincount(shell[asking], chosen, len(area)) for chosen in (None, distance <= LYING * unit, is_near)
        )
        is_waiting &= n_lying <= LYING_SHARE * n_vertices
        is_new = is_waiting & (n_near > 0)
        if not is_new.any():
            break
        is_joined |= is_new
        is_waiting &= ~is_new
        spanned = is_near & is_new[shell[asking]]
        feet.append(nearest[spanned])
        heads.append(asking[spanned])
    return _bridges(mesh, is_joined, feet, heads)


def large_shells(mesh: TriangleMesh) -> Bools:
    """Return (S,) the mask of the shells that are no details; the largest never is one."""
    area = np.bincount(mesh.component_of_triangle, mesh.areas)
    return (area >= LEAST_SHARE * area.sum()) | (np.arange(len(area)) == 0)


def _bridges(mesh: TriangleMesh, is_joined: Bools, feet: list[Ints], heads: list[Ints]) -> Bridges:
    if not heads:
        return Bridges(is_joined, np.empty((0, 3), dtype=np.int64), np.empty(0, dtype=np.int64))
    foot, head = np.concatenate(feet), np.concatenate(heads)
    edge, other = _edge_towards(mesh, foot, mesh.vertices[head])
    triangle_of_edge = np.empty(len(mesh.edges.vertices), dtype=np.int64)
    triangle_of_edge[mesh.edges.of_triangle] = np.arange(len(mesh.triangles))[:, None]
    return Bridges(is_joined, np.stack([head, foot, other], axis=1), triangle_of_edge[edge])


def _edge_towards(mesh: TriangleMesh, start: Ints, goal: Floats) -> tuple[Ints, Ints]:
    """Return for each start the edge from it, and the vertex at its end, that comes nearest to a goal."""
    edges = mesh.edges.vertices
    tails, ends = edges.ravel(), edges[:, ::-1].ravel()
    by_tail = np.argsort(tails, kind="stable")
    first, behind = (np.searchsorted(tails[by_tail], start, side) for side in ("left", "right"))
    row = np.repeat(np.arange(len(start)), behind - first)
    side = by_tail[np.arange(len(row)) - np.repeat(np.cumsum(behind - first) - behind, behind - first)]
    distance = np.linalg.norm(mesh.vertices[ends[side]] - goal[row], axis=1)
    nearest = np.lexsort((evened(distance), row))
    side = side[nearest[np.searchsorted(row, np.arange(len(start)))]]
    return side // 2, ends[side]


def _shell_of_vertex(mesh: TriangleMesh) -> Ints:
    shell = np.full(len(mesh.vertices), -1)
    shell[mesh.triangles] = mesh.component_of_triangle[:, None]
    return shell


def _chosen(is_chosen: Bools, shell: Ints) -> Bools:
    return np.append(is_chosen, False)[shell]


def _mean_edge_length(mesh: TriangleMesh) -> Floats:
    """Return (V,) the mean length of the edges at each vertex."""
    ends = mesh.edges.vertices
    length = np.linalg.norm(mesh.vertices[ends[:, 1]] - mesh.vertices[ends[:, 0]], axis=1)
    total = np.bincount(ends.ravel(), np.repeat(length, 2), len(mesh.vertices))
    return total / np.maximum(np.bincount(ends.ravel(), minlength=len(mesh.vertices)), 1)
