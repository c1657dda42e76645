"""Random meshes, from whole shapes to what is hardly one; V vertices, T triangles."""

from itertools import combinations

import numpy as np

from compute.surface.mesh import Floats, Ints
from tests.damage import DAMAGES, SHAPES, damaged
from tests.shapes import rectangle

Mesh = tuple[Floats, Ints]
# What a coordinate that nobody uses may be.
NOWHERE = (np.nan, np.inf, -np.inf, 1e300, -1e300, 1e6)


def random_mesh(rng: np.random.Generator) -> Mesh:
    """Return a mesh of any kind, in a third of all cases with vertices that no face uses."""
    with np.errstate(all="ignore"):
        vertices, triangles = KINDS[rng.integers(len(KINDS))](rng)
    return with_loose(vertices, triangles, rng) if rng.random() < 1 / 3 else (vertices, triangles)


def with_loose(vertices: Floats, triangles: Ints, rng: np.random.Generator) -> Mesh:
    """Return a mesh with vertices between the others that no face uses, wherever they are."""
    n_loose = int(rng.integers(1, 4))
    order = np.sort(rng.permutation(len(vertices) + n_loose)[: len(vertices)])
    places = rng.choice(NOWHERE, (len(vertices) + n_loose, 3))
    places[order] = vertices
    return places, order[np.asarray(triangles)]


def whole_shape(rng: np.random.Generator) -> Mesh:
    """Return a shape as it is, in another pose and size."""
    shape = SHAPES[rng.choice(sorted(SHAPES))]
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    return 10.0 ** rng.integers(-5, 6) * shape.vertices @ turn, shape.triangles


def broken_shape(rng: np.random.Generator) -> Mesh:
    """Return a shape after up to three damages."""
    steps = [(str(name), float(rng.random() ** 2)) for name in rng.choice(sorted(DAMAGES), rng.integers(1, 4))]
    return damaged(str(rng.choice(sorted(SHAPES))), steps, int(rng.integers(2**32)), int(rng.integers(-8, 9)))


def huge_or_tiny(rng: np.random.Generator) -> Mesh:
    """Return a shape in any unit, drawn out along one axis, and far from the origin."""
    shape = SHAPES[rng.choice(sorted(SHAPES))]
    vertices = shape.vertices * [1, 1, 10.0 ** rng.integers(-6, 7)] * 10.0 ** rng.integers(-80, 81)
    return vertices + rng.choice([0, 1e-3, 1e8]) * rng.standard_normal(3), shape.triangles


def soup(rng: np.random.Generator) -> Mesh:
    """Return triangles between any three of a few places."""
    n_vertices = int(rng.integers(3, 14))
    vertices = rng.standard_normal((n_vertices, 3))
    triangles = rng.integers(0, n_vertices, (int(rng.integers(2, 30)), 3))
    return (np.round(vertices) if rng.random() < 0.3 else vertices), triangles


def all_triples(rng: np.random.Generator) -> Mesh:
    """Return many of the triangles that some places have between them."""
    n_vertices = int(rng.integers(4, 9))
    triples = np.array(list(combinations(range(n_vertices), 3)))
    return rng.standard_normal((n_vertices, 3)), triples[rng.random(len(triples)) < rng.uniform(0.3, 1.1)]


def wheel(rng: np.random.Generator) -> Mesh:
    """Return triangles around one vertex, flat or a cone, in one layer or several."""
    n = int(rng.integers(3, 40))
    angle = 2 * np.pi * np.arange(n) / n
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(n)], axis=1)
    spokes = [(0, 1 + k, 1 + (k + step) % n) for step in range(1, int(rng.integers(2, 4))) for k in range(n)]
    return np.vstack([[0, 0, rng.choice([0, 1, 1e3])], rim]), np.array(spokes)


def book(rng: np.random.Generator) -> Mesh:
    """Return triangles that share one edge."""
    n = int(rng.integers(2, 12))
    pages = np.stack([np.cos(np.arange(n)), np.sin(np.arange(n)), rng.random(n)], axis=1)
    return np.vstack([[0, 0, 0], [0, 0, 1], pages]), np.array([(0, 1, 2 + page) for page in range(n)])


def steps(rng: np.random.Generator) -> Mesh:
    """Return a sheet of two heights."""
    sheet = rectangle(*map(int, rng.integers(1, 8, 2)))
    vertices = sheet.vertices.copy()
    vertices[:, 2] = rng.integers(0, 2, len(vertices)) * rng.choice([0, 1e-12, 1e-3, 1, 1e3])
    return vertices, sheet.triangles


def shells(rng: np.random.Generator) -> Mesh:
    """Return some shapes beside, in or on each other."""
    vertices, triangles, first = [], [], 0
    for name in rng.choice(sorted(SHAPES), int(rng.integers(2, 5))):
        size, away = rng.choice([1e-3, 0.1, 1, 1, 10]), rng.choice([0, 1e-9, 0.5, 3, 1e6])
        vertices.append(SHAPES[name].vertices * size + away * rng.standard_normal(3))
        triangles.append(SHAPES[name].triangles + first)
        first += len(vertices[-1])
    return np.vstack(vertices), np.vstack(triangles)


# Shapes that can be divided are wanted most.
KINDS = (*(whole_shape, broken_shape, huge_or_tiny) * 2, shells, soup, all_triples, wheel, book, steps)
