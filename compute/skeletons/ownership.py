"""Bones of vertices: on limbs that of their level set, in the body the nearest."""

import numpy as np
from scipy.spatial import cKDTree

from ..analysis.analysis import Analysis
from ..surface.mesh import Floats, Ints
from ..surface.ties import first_least
from .joint_tree import JointTree
from .slices import Slices


def bones_of_vertices(analysis: Analysis, slices: Slices, tree: JointTree) -> Ints:
    """Return (V,) the bone of each vertex of the input, by the joint it ends in."""
    surface, net = analysis.surface, analysis.net
    n_vertices = len(analysis.mesh.vertices)
    slice_of = np.full(len(net.positions), -1)
    slice_of[net.triangles.ravel()] = np.repeat(slices.of_triangle, 3)
    slice_of = slice_of[:n_vertices][surface.vertex_of_input]
    analyzed = np.flatnonzero(slice_of >= 0)
    owner = np.full(n_vertices, -1)
    owner[analyzed] = tree.bone_of_slice[slice_of[analyzed]]
    # Between two limbs the level sets lie askew: there the nearest bone is the better guide.
    in_body = (owner < 0) | (tree.part[owner] == tree.part[0])
    in_body &= slice_of >= 0
    lost = np.flatnonzero(in_body)
    owner[lost] = _nearest_bone(analysis.mesh.vertices[lost], slices.part[slice_of[lost]], tree)
    return _spread(owner, analysis)


def _nearest_bone(points: Floats, part_of_point: Ints, tree: JointTree) -> Ints:
    """Return the nearest bone among those of the same part, or of all where a part has none."""
    bones = np.arange(1, len(tree.places))
    start = tree.places[tree.parent[bones]]
    along = tree.places[bones] - start
    square = np.maximum(np.einsum("bj,bj->b", along, along), np.finfo(float).tiny)
    owner = np.empty(len(points), dtype=np.int64)
    for label in np.unique(part_of_point).tolist():
        rows = np.flatnonzero(part_of_point == label)
        of_part = np.flatnonzero(tree.part[bones] == label)
        of_part = of_part if len(of_part) else np.arange(len(bones))
        from_start = points[rows, None] - start[of_part]
        share = np.clip(np.einsum("pbj,bj->pb", from_start, along[of_part]) / square[of_part], 0, 1)
        distance = np.linalg.norm(from_start - share[:, :, None] * along[of_part], axis=2)
        owner[rows] = bones[of_part[first_least(distance)]]
    return owner


def _spread(owner: Ints, analysis: Analysis) -> Ints:
    """Give vertices that were not analyzed the bone of the nearest that was."""
    missing = np.flatnonzero(owner < 0)
    if not len(missing):
        return owner
    known = np.flatnonzero(owner >= 0)
    vertices = analysis.mesh.vertices
    owner[missing] = owner[known[cKDTree(vertices[known]).query(vertices[missing])[1]]]
    return owner
