"""Ways in which meshes get broken, each by a share of what there is; V vertices, T triangles."""

from collections.abc import Callable

import numpy as np

from compute.surface.mesh import Floats, Ints
from tests.shapes import icosphere, joined, rectangle, star, tetrahedron, torus

Damage = Callable[[Floats, Ints, float, np.random.Generator], tuple[Floats, Ints]]

SHAPES = {
    "ball": icosphere(2),
    "star": star(n_arms=4, n_subdivisions=2),
    "ring": torus(14, 8),
    "sheet": rectangle(9, 6),
    "tetrahedron": tetrahedron(1),
    "two shells": joined(icosphere(1), star(n_arms=3, n_subdivisions=2)),
}


def delete_faces(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Leave holes, vertices without faces and, if the share is large, crumbs."""
    return vertices, triangles[rng.random(len(triangles)) >= share]


def flip_faces(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Turn faces inside out."""
    turned = rng.random(len(triangles)) < share
    return vertices, np.where(turned[:, None], triangles[:, ::-1], triangles)


def merge_vertices(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Let vertices be others, anywhere: pinched, non-manifold, collapsed."""
    index = np.arange(len(vertices))
    merged = rng.random(len(vertices)) < share
    index[merged] = rng.integers(0, len(vertices), merged.sum())
    return vertices, index[triangles]


def split_vertices(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Give corners a vertex of their own at the same place."""
    corners = triangles.ravel().copy()
    own = np.flatnonzero(rng.random(len(corners)) < share)
    corners[own] = len(vertices) + np.arange(len(own))
    return np.vstack([vertices, vertices[triangles.ravel()[own]]]), corners.reshape(-1, 3)


def duplicate_faces(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Repeat faces, some of them the other way round."""
    again = triangles[rng.random(len(triangles)) < share]
    return vertices, np.vstack([triangles, again, again[::2, ::-1]])


def shake_vertices(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Move vertices by a share of the extent: creases, slivers, faces through one another."""
    return vertices + share * np.ptp(vertices) * rng.standard_normal(vertices.shape), triangles


def flatten_faces(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Put corners of faces into one place without merging them: no area, no length."""
    vertices = vertices.copy()
    flat = triangles[rng.random(len(triangles)) < share]
    vertices[flat[:, 1]] = vertices[flat[:, 0]]
    return vertices, triangles


def add_loose_vertices(
    vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator
) -> tuple[Floats, Ints]:
    """Add vertices that no face uses, far away and in front of all others, one of them nowhere."""
    n_loose = 1 + int(share * len(vertices))
    loose = 100 * rng.standard_normal((n_loose, 3))
    loose[0] = np.nan
    return np.vstack([loose, vertices]), triangles + n_loose


def lose_coordinates(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Make coordinates that are not numbers, or not finite."""
    vertices = vertices.copy()
    lost = rng.random(len(vertices)) < share
    vertices[lost, rng.integers(0, 3)] = rng.choice([np.nan, np.inf, -np.inf])
    return vertices, triangles


def keep_few_faces(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Keep one to four faces, neighbours or not."""
    return vertices, rng.permutation(triangles)[: 1 + int(4 * share)]


def stretch(vertices: Floats, triangles: Ints, share: float, rng: np.random.Generator) -> tuple[Floats, Ints]:
    """Draw the shape out into a needle."""
    return vertices * [1.0, 1.0, 10 ** (6 * share)], triangles


DAMAGES: dict[str, Damage] = {
    damage.__name__: damage
    for damage in (
        *(delete_faces, flip_faces, merge_vertices, split_vertices, duplicate_faces, shake_vertices, flatten_faces),
        *(add_loose_vertices, lose_coordinates, keep_few_faces, stretch),
    )
}


def damaged(shape: str, steps: list[tuple[str, float]], seed: int, exponent: int = 0) -> tuple[Floats, Ints]:
    """Return the vertices, in units of 10^exponent, and triangles of a shape after some damages in a row."""
    vertices, triangles = SHAPES[shape].vertices, SHAPES[shape].triangles
    rng = np.random.default_rng(seed)
    for name, share in steps:
        vertices, triangles = DAMAGES[name](vertices, triangles, share, rng)
    return vertices * 10.0**exponent, triangles
