"""Twins: features that a symmetry maps onto each other, in space or, in other poses, by the eigenfunctions."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...fem.eigenbasis import Eigenbasis
from ...fields.scalar_field import Net
from ...surface.assignment import cheapest_assignment
from ...surface.mesh import Floats, Ints
from ...surface.ties import ROUNDING

# Points by which a symmetry is judged, spread over the numbers of the vertices.
N_SAMPLES = 800
# Twins are equally high up to this fraction of the field's range.
LEAST_ALIKE = 0.05
# Pairs of extrema that a symmetry is sought by, and how far from each other they are at least, like all distances below
# in units of the root mean square of the coordinates.
N_SEEDS, LEAST_APART = 8, 0.3
# The coordinates of twins differ by their signs: by less than this fraction of their length otherwise.
MOST_UNLIKE = 0.8
# A symmetry lands this near to the points of the surface; a human has 0.01 to 0.03, a kicking horse 0.05, a hand 0.2.
# Its images of features are this near to their twins.
NEAR = 0.06
NEAR_FEATURE = 0.1
# Rounds in which a symmetry settles.
MOST_ROUNDS = 6
# If one saddle is e times as persistent as another, that speaks against twins as much as this distance between them.
PERSISTENT = 0.02
# A shape is symmetric in space if its reflection lies this near to it, in units of the root of its area.
SAME_PLACE = 0.01


@dataclass(frozen=True, eq=False)
class _Symmetry:
    """A map of a surface onto itself that swaps its sides, in coordinates in which it is linear.

    Attributes
    ----------
    points : (n, k) float64
        Of the vertices of the net, in units of the size of the whole.
    rotation : (k, k) float64
        Maps each point near to its twin.
    across : (k,) float64
        The direction in which the two sides lie apart.
    """

    points: Floats
    rotation: Floats
    across: Floats


def find_twins(
    net: Net, basis: Eigenbasis, extrema: Ints, saddles: Ints, heights: Floats, persistence: Floats
) -> tuple[Ints, Ints]:
    """Return for each extremum and each saddle the place of its twin in the same list, its own where it has none.

    Parameters
    ----------
    net : Net
        Of n vertices.
    basis : Eigenbasis
        On these vertices.
    extrema, saddles : (e,), (s,) int64
        Vertices of the net.
    heights : (n,) float64
        The field on the net.
    persistence : (s,) float64
        Of each saddle, more than 0.

    References
    ----------
    .. [1] Ovsjanikov, Sun, Guibas, "Global Intrinsic Symmetries of Shapes", SGP 2008: eigenfunctions are even or odd
       under a symmetry.
    """
    even = heights / max(float(np.ptp(heights[net.used])), float(np.finfo(float).tiny))
    symmetry = _in_space(net) or _on_surface(net, basis, extrema, even)
    if symmetry is None:
        return np.arange(len(extrema)), np.arange(len(saddles))
    extremum = _matched(symmetry.points[extrema], even[extrema, None], symmetry)
    traits = np.column_stack([even[saddles], PERSISTENT * np.log(persistence)])
    return extremum, _matched(symmetry.points[saddles], traits, symmetry)


def _samples(net: Net) -> Ints:
    return net.used[np.linspace(0, len(net.used) - 1, min(N_SAMPLES, len(net.used))).astype(np.int64)]


def _in_space(net: Net) -> _Symmetry | None:
    """Return the reflection across x, y or z that maps a shape onto itself, if there is one."""
    size = float(np.sqrt(net.areas.sum()))
    centre = net.areas @ net.positions[net.triangles].mean(axis=1) / net.areas.sum()
    points = (net.positions - centre) / size
    tree, samples = cKDTree(points[net.used]), points[_samples(net)]
    for axis in np.eye(3):
        reflection = np.diag(1 - 2 * axis)
        if tree.query(samples @ reflection)[0].mean() < SAME_PLACE:
            return _Symmetry(points, reflection, axis)
    return None


def _on_surface(net: Net, basis: Eigenbasis, extrema: Ints, heights: Floats) -> _Symmetry | None:
    """Return the rotation in the space of eigenfunctions that maps a surface onto itself, if there is one."""
    is_curved = basis.values > ROUNDING * basis.values[-1]
    points = basis.functions[:, is_curved] / np.sqrt(basis.values[is_curved])
    size = float(np.sqrt((points[_samples(net)] ** 2).sum(axis=1).mean()))
    if size == 0:
        return None
    points /= size
    samples = points[_samples(net)]
    tree, best, least = cKDTree(samples), None, NEAR
    for signs in _signs(points[extrema], heights[extrema]):
        rotation = _settled(np.diag(signs), samples, tree)
        images = samples @ rotation.T
        distance = float(tree.query(images)[0].mean())
        # Some searches end where everything is its own image.
        if distance < least and np.linalg.norm(images - samples, axis=1).mean() > LEAST_APART:
            best, least = rotation, distance
    if best is None:
        return None
    across = np.linalg.svd(samples - samples @ best.T, full_matrices=False)[2][0]
    return _Symmetry(points, best, across)


def _settled(rotation: Floats, samples: Floats, tree: cKDTree) -> Floats:
    """Return the rotation that maps samples best to those that they land next to."""
    for _ in range(MOST_ROUNDS):
        landed = samples[tree.query(samples @ rotation.T)[1]]
        left, _, right = np.linalg.svd(landed.T @ samples)
        before, rotation = rotation, left @ right
        if np.allclose(before, rotation, atol=1e-3):
            break
    return rotation


def _signs(extrema: Floats, heights: Floats) -> list[Floats]:
    """Return the signs (k,) by which the coordinates of some pairs of extrema differ, the most alike first."""
    length = np.linalg.norm(extrema, axis=1)
    unlike = np.linalg.norm(np.abs(extrema[:, None]) - np.abs(extrema), axis=2) / np.maximum(length[:, None], ROUNDING)
    apart = np.linalg.norm(extrema[:, None] - extrema, axis=2)
    is_seed = (np.abs(heights[:, None] - heights) < LEAST_ALIKE) & (apart > LEAST_APART) & (unlike < MOST_UNLIKE)
    first, second = np.nonzero(np.tril(is_seed))
    order = np.argsort(unlike[first, second], kind="stable")[:N_SEEDS]
    signs = np.where(extrema[first[order]] * extrema[second[order]] < 0, -1.0, 1.0)
    return list(np.unique(signs, axis=0))


def _matched(points: Floats, traits: Floats, symmetry: _Symmetry) -> Ints:
    """Return the place of the twin of each of some points (m, k), alike in traits (m, t), its own for what has none.

    The whole of one side is matched with the whole of the other. As distances are squared, it does not matter if all on
    one side, such as the fingers of a hand, land a little beside their twins.
    """
    distance = ((points @ symmetry.rotation.T)[:, None] - points) ** 2
    cost = distance.sum(axis=2) + ((traits[:, None] - traits) ** 2).sum(axis=2)
    alone = np.minimum(np.diag(cost), NEAR_FEATURE**2)
    is_left = points @ symmetry.across > 0
    left, right = np.flatnonzero(is_left), np.flatnonzero(~is_left)
    # Beside the right ones stands each left one itself, for where it stays alone, and the other way round.
    both = np.zeros((len(points), len(points)))
    both[: len(left), : len(right)] = (cost + cost.T)[np.ix_(left, right)]
    both[: len(left), len(right) :] = np.where(np.eye(len(left), dtype=bool), alone[left], np.inf)
    both[len(left) :, : len(right)] = np.where(np.eye(len(right), dtype=bool), alone[right], np.inf)
    rows, columns = cheapest_assignment(both)
    twin = np.arange(len(points))
    paired = (rows < len(left)) & (columns < len(right))
    twin[left[rows[paired]]], twin[right[columns[paired]]] = right[columns[paired]], left[rows[paired]]
    return twin
