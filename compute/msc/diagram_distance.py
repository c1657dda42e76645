"""Distances of two persistence diagrams."""

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching
from scipy.spatial import cKDTree

from ..errors import FieldError
from ..memory import told_if_full
from ..surface.mesh import Bools, Floats, Ints
from .diagram import PersistenceDiagram

# The search for the bottleneck is narrowed to this fraction of its value before distances are listed.
NARROW = 1e-3
# Denormal numbers cannot be halved for ever.
MOST_HALVINGS = 200


@told_if_full
def diagram_distance(first: PersistenceDiagram, second: PersistenceDiagram, metric: str = "hausdorff") -> float:
    """Return the distance of two separated diagrams in the maximum norm; the diagonal belongs to both.

    The points of pairs are compared, not the essential ones. A minimum and a maximum are never closer to each other
    than the farther of the two is to the diagonal, so the distance does not mix them up.

    Parameters
    ----------
    first, second : PersistenceDiagram
        In one unit.
    metric : "hausdorff" or "bottleneck"
        The distance of the worst point from its nearest one, or from its own one in the best matching.

    Returns
    -------
    float
        In the unit of the field.

    Raises
    ------
    FieldError
        If there is no such metric.

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, section 4.5; the maximum norm of its footnote 8 lacks the absolute values.

    Examples
    --------
    >>> diagram_distance(analysis.diagram, analysis.diagram, "bottleneck")
    0.0
    """
    if metric == "hausdorff":
        return hausdorff_distance(first.points, second.points)
    if metric == "bottleneck":
        return bottleneck_distance(first.points, second.points)
    raise FieldError(f'The metric is "hausdorff" or "bottleneck", not "{metric}".')


def hausdorff_distance(first: Floats, second: Floats) -> float:
    """Return the largest distance of a point from the other diagram, (n, 2) and (m, 2)."""
    of_first = np.minimum(_to_nearest(first, second), _to_diagonal(first))
    of_second = np.minimum(_to_nearest(second, first), _to_diagonal(second))
    return float(max(of_first.max(initial=0.0), of_second.max(initial=0.0)))


def bottleneck_distance(first: Floats, second: Floats) -> float:
    """Return the least r such that the points can be matched within r, to each other or to the diagonal."""
    # The answer is 0, the distance of two points, or that of a point from the diagonal; the last is an upper bound.
    to_diagonal = np.concatenate([_to_diagonal(first), _to_diagonal(second)])
    low, high = hausdorff_distance(first, second), float(to_diagonal.max(initial=0.0))
    if _can_match(first, second, low):
        return low
    for _ in range(MOST_HALVINGS):
        if high - low <= NARROW * high:
            break
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _can_match(first, second, middle) else (middle, high)
    near = _distances(first, second, high * (1 + NARROW))[2]
    candidates = np.unique(np.concatenate([[0.0], near, to_diagonal, [low]]))
    candidates = candidates[(candidates >= low) & (candidates <= high * (1 + NARROW))]
    below, above = -1, len(candidates) - 1
    while above - below > 1:
        middle_place = (below + above) // 2
        is_enough = _can_match(first, second, candidates[middle_place])
        below, above = (below, middle_place) if is_enough else (middle_place, above)
    return float(candidates[above]) if len(candidates) else 0.0


def _can_match(first: Floats, second: Floats, radius: float) -> bool:
    """Return whether all points farther than the radius from the diagonal find partners within it.

    If those of either diagram can be matched by themselves, they can be matched together (Mendelsohn, Dulmage 1958).
    """
    rows, columns, _ = _distances(first, second, radius)
    near = csr_array((np.ones(len(rows), dtype=bool), (rows, columns)), shape=(len(first), len(second)))
    far_first, far_second = _to_diagonal(first) > radius, _to_diagonal(second) > radius
    return _all_matched(near, far_first) and _all_matched(csr_array(near.T), far_second)


def _all_matched(near: csr_array, wanted: Bools) -> bool:
    if not wanted.any():
        return True
    if 0 in near.shape:
        return False
    return bool((maximum_bipartite_matching(near[np.flatnonzero(wanted)], perm_type="column") >= 0).all())


def _distances(first: Floats, second: Floats, radius: float) -> tuple[Ints, Ints, Floats]:
    """Return rows, columns and distances of all pairs of points within a radius, in the maximum norm."""
    if len(first) == 0 or len(second) == 0:
        return np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64), np.empty(0)
    # The tree's own comparison may round away a pair at just this distance.
    pairs = cKDTree(first).sparse_distance_matrix(
        cKDTree(second), radius * (1 + 1e-12) + np.finfo(float).tiny, p=np.inf, output_type="ndarray"
    )
    distance = np.abs(first[pairs["i"]] - second[pairs["j"]]).max(axis=1)
    within = distance <= radius
    return pairs["i"][within], pairs["j"][within], distance[within]


def _to_nearest(points: Floats, others: Floats) -> Floats:
    if len(others) == 0:
        return np.full(len(points), np.inf)
    return cKDTree(others).query(points, p=np.inf)[0] if len(points) else np.empty(0)


def _to_diagonal(points: Floats) -> Floats:
    return np.abs(points[:, 1] - points[:, 0]) / 2
