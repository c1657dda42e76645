"""Labels without what borders along edges have moved, which all that is computed from parts reads."""

import numpy as np
from numpy.typing import NDArray

from ...surface.mesh import Ints
from .face_graph import FaceGraph
from .part_tree import PartTree

UNKNOWN = -1


def exact_labels(labels: NDArray[np.int32], part_tree: PartTree, graph: FaceGraph) -> NDArray[np.int32]:
    """Return labels in which each face is in the part that has the greater half of it; those that are so stay.

    A face that is shown elsewhere gets the label of the nearest one that no level divides from it and that is not.

    Parameters
    ----------
    labels : (F,) int32
        Of the faces of the part tree, from any level, corrected or not.
    part_tree : PartTree
    graph : FaceGraph
        Of these faces.
    """
    labels = labels.copy()
    own, shown = _regions(part_tree)
    is_known = own == shown
    # Parts that lie between a border and its level set alone were put there.
    is_open = ~is_known & np.isin(labels, labels[is_known])
    usual = np.full(int(own.max()) + 1, UNKNOWN, dtype=labels.dtype)
    usual[own[is_known]] = labels[is_known]
    together = graph.neighbours[own[graph.neighbours[:, 0]] == own[graph.neighbours[:, 1]]]
    near = np.vstack([together, together[:, ::-1]])
    while True:
        inside, outside = near[is_open[near[:, 0]] & is_known[near[:, 1]]].T
        if not len(inside):
            break
        labels[inside] = labels[outside]
        is_open[inside], is_known[inside] = False, True
    # What hangs together with nothing that is known is as the rest of its region.
    return np.where(is_open & (usual[own] != UNKNOWN), usual[own], labels)


def _regions(part_tree: PartTree) -> tuple[Ints, Ints]:
    """Return (F,) the number of what no level divides that each face lies in, and that it is shown in."""
    columns = []
    for tree, is_end, pieces in zip(part_tree.trees, part_tree.ends, part_tree.branches, strict=True):
        region = tree.spread(np.where(is_end, 1 + np.arange(len(is_end)), 0))
        columns.append(region[np.concatenate([pieces.arc, pieces.shown])])
    number = np.unique(np.stack(columns), axis=1, return_inverse=True)[1].reshape(2, -1)
    own, shown = number[:, part_tree.branches[0].of_face]
    return own, shown
