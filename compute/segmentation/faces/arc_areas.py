"""Shares of the faces on the arcs, by cutting the net's triangles along the level sets of the saddles."""

from dataclasses import dataclass

import numpy as np

from ...fields.scalar_field import Net, share_below
from ...surface.mesh import Floats, Ints
from ..hierarchy.arc_tree import ArcTree

# A face is halved if its shares differ from one half by less: where the field hardly rises within a face, shares are
# rounded this much.
HALVED = 1e-6


@dataclass(frozen=True, eq=False)
class ArcAreas:
    """Shares of faces, one row for each face and arc that meet.

    Attributes
    ----------
    face : (r,) int64
    arc : (r,) int64
    area : (r,) float64
    """

    face: Ints
    arc: Ints
    area: Floats


def arc_areas(values: Floats, arc: Ints, tree: ArcTree, net: Net, face: Ints) -> ArcAreas:
    """Cut each triangle of the net at the saddles that end the arcs it reaches over.

    Whatever is connected to the lowest corner of a triangle from below lies on the arcs between that corner's and the
    highest corner's, which is a single path of the tree; so the shares follow from the levels alone.

    Parameters
    ----------
    values : (n,) float64
        The field.
    arc : (n,) int64
        Arc of each net vertex.
    tree : ArcTree
    net : Net
        With m triangles.
    face : (m,) int64
        The face each triangle of the net belongs to.
    """
    rising = -values if tree.is_of_maxima else values
    heights = np.sort(rising[net.triangles], axis=1)
    arcs = arc[net.triangles]
    # A parent has a larger index than its children, so along a path the index tells the order.
    first, last = arcs.min(axis=1), arcs.max(axis=1)
    inside = first == last
    rows = [(face[inside], first[inside], net.areas[inside])]
    crossing = np.flatnonzero(~inside)
    current, below = first[crossing], np.zeros(len(crossing))
    while len(crossing):
        is_last = current == last[crossing]
        level = np.where(is_last, np.inf, rising[tree.saddle[current]])
        reached = np.maximum(share_below(heights[crossing], level), below)
        rows.append((face[crossing], current, net.areas[crossing] * (reached - below)))
        crossing, current, below = crossing[~is_last], tree.parent[current[~is_last]], reached[~is_last]
    return ArcAreas(*(np.concatenate(column) for column in zip(*rows, strict=True)))
