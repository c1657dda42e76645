"""Isomorphism of triangle meshes: the same faces under other numbers.

From one triangle that is known, all others follow across their edges.
"""

from dataclasses import dataclass

import numpy as np

from ...surface.mesh import Bools, Ints

# First triangles that are tried.
MOST_SEEDS = 20


@dataclass(frozen=True, eq=False)
class _Sides:
    """The sides of wound triangles, findable by their ends.

    Attributes
    ----------
    keys : (3 T,) int64
        Tail times number of vertices plus head, ascending.
    opposite : (3 T,) int64
        The third corner of the triangle.
    """

    keys: Ints
    opposite: Ints
    n_vertices: int

    def find(self, tails: Ints, heads: Ints) -> Ints:
        """Return the third corner at the left of each side, -1 where there is no triangle."""
        wanted = tails * self.n_vertices + heads
        place = np.minimum(np.searchsorted(self.keys, wanted), len(self.keys) - 1)
        return np.where(self.keys[place] == wanted, self.opposite[place], -1)


def may_be_isomorphic(source: Ints, target: Ints) -> bool:
    """Whether there are as many triangles around vertices of the same valences, so that a closer look is worth it."""
    return len(source) == len(target) and _valences(source) == _valences(target)


def isomorphism(source: Ints, target: Ints, n_source: int, n_target: int, guess: Ints) -> Ints | None:
    """Return the source vertex that each target vertex is under another number; None if the faces differ.

    Parameters
    ----------
    source, target : (T, 3) int64
        Triangles, both wound consistently.
    n_source, n_target : int
        Numbers of vertices.
    guess : (n_target,) int64
        The source vertex that each may be; one triangle where it is right is enough.

    Returns
    -------
    (n_target,) int64 or None
        -1 for vertices without triangles.
    """
    source_sides, target_sides = _sides(source, n_source), _sides(target, n_target)
    if source_sides is None or target_sides is None:
        return None
    corners = guess[target]
    fits = np.flatnonzero(source_sides.find(corners[:, 0], corners[:, 1]) == corners[:, 2])
    # Spread over the surface, as the guess is wrong in whole regions.
    for seed in fits[:: max(1, len(fits) // MOST_SEEDS)].tolist():
        image = _grown(source_sides, target_sides, target[seed], guess[target[seed]])
        if image is not None and _is_complete(image, source, target):
            return image
    return None


def _valences(triangles: Ints) -> bytes:
    """Return the number of vertices of each valence."""
    counts = np.bincount(triangles.ravel())
    return np.bincount(counts[counts > 0]).tobytes()


def _sides(triangles: Ints, n_vertices: int) -> _Sides | None:
    """Return the sides of triangles; None where two triangles have the same one, so that growth is not unique."""
    tails, heads, opposite = (np.roll(triangles, -k, axis=1).ravel() for k in range(3))
    keys = tails * n_vertices + heads
    order = np.argsort(keys, kind="stable")
    if (np.diff(keys[order]) == 0).any():
        return None
    return _Sides(keys[order], opposite[order], n_vertices)


def _grown(source: _Sides, target: _Sides, seed: Ints, start: Ints) -> Ints | None:
    """Return the images of all vertices that are reached from a triangle; None at the first contradiction."""
    image = np.full(target.n_vertices, -1)
    image[seed] = start
    front = np.stack([np.roll(seed, -1), seed], axis=1)
    reached = np.zeros(len(target.keys), dtype=bool)
    while len(front):
        tails, heads = front.T
        third = target.find(tails, heads)
        third_image = source.find(image[tails], image[heads])
        if ((third < 0) != (third_image < 0)).any():
            return None
        inside = third >= 0
        tails, heads, third, third_image = tails[inside], heads[inside], third[inside], third_image[inside]
        known = image[third]
        if ((known >= 0) & (known != third_image)).any():
            return None
        image[third] = third_image
        if (image[third] != third_image).any():
            return None
        # Behind the two other sides of each triangle lie the next ones.
        front = np.concatenate([np.stack([third, heads], axis=1), np.stack([tails, third], axis=1)])
        front = front[_first_time(reached, target, front)]
    return image


def _first_time(reached: Bools, target: _Sides, front: Ints) -> Ints:
    """Return the rows of the sides that were not passed before, each once, and mark them; all beyond the border."""
    wanted = front[:, 0] * target.n_vertices + front[:, 1]
    place = np.minimum(np.searchsorted(target.keys, wanted), len(target.keys) - 1)
    has_triangle = target.keys[place] == wanted
    inside = np.flatnonzero(has_triangle)
    place, first = np.unique(place[inside], return_index=True)
    fresh = ~reached[place]
    reached[place[fresh]] = True
    return np.concatenate([np.flatnonzero(~has_triangle), inside[first[fresh]]])


def _is_complete(image: Ints, source: Ints, target: Ints) -> bool:
    """Whether every target triangle became another source triangle."""
    mapped = image[target]
    if (mapped < 0).any():
        return False
    return np.array_equal(_sorted_triangles(mapped), _sorted_triangles(source))


def _sorted_triangles(triangles: Ints) -> Ints:
    ordered = np.sort(triangles, axis=1)
    return ordered[np.lexsort(ordered.T)]
