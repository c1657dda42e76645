"""Surfaces of known topology and fields on them."""

import numpy as np

from compute.msc.diagram import PersistenceDiagram
from compute.msc.links import links_of
from compute.msc.morse_smale import FieldTopology, MorseSmaleComplex
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, rectangle, torus


def topology(mesh: TriangleMesh, values: np.ndarray) -> FieldTopology:
    return FieldTopology(links_of(mesh.triangles, len(mesh.vertices)), mesh.vertices, values)


def diagram_of(mesh: TriangleMesh, values: np.ndarray) -> PersistenceDiagram:
    return MorseSmaleComplex(topology(mesh, values)).diagram


def closed_surface(genus: int) -> TriangleMesh:
    """Return a sphere with handles: tori glued along a triangle each; only their connectivity has a meaning."""
    mesh = icosphere(2) if genus == 0 else torus(12, 8)
    for _ in range(genus - 1):
        mesh = glued(mesh, torus(12, 8))
    return mesh


def glued(mesh: TriangleMesh, other: TriangleMesh) -> TriangleMesh:
    """Cut the last triangle out of one mesh and the first out of the other, and join the holes."""
    number = len(mesh.vertices) + np.arange(len(other.vertices))
    number[other.triangles[0]] = mesh.triangles[-1][::-1]
    shifted = other.vertices + 2 * np.ptp(mesh.vertices, axis=0).max()
    triangles = np.concatenate([mesh.triangles[:-1], number[other.triangles[1:]]])
    return TriangleMesh(np.concatenate([mesh.vertices, shifted]), triangles)


def with_holes(mesh: TriangleMesh, rng: np.random.Generator, share: float = 0.1) -> TriangleMesh:
    """Leave out some triangles; holes may touch at a vertex."""
    return TriangleMesh(mesh.vertices, mesh.triangles[rng.random(len(mesh.triangles)) > share])


def noise(mesh: TriangleMesh, rng: np.random.Generator) -> np.ndarray:
    return rng.normal(size=len(mesh.vertices))


def waves(mesh: TriangleMesh, rng: np.random.Generator) -> np.ndarray:
    """A smooth function of the position."""
    places = mesh.vertices / np.ptp(mesh.vertices, axis=0).max()
    return np.sin(places @ rng.normal(size=(3, 4)) * 4 + rng.uniform(0, 6, 4)) @ rng.normal(size=4)


def annulus(n_around: int = 24) -> TriangleMesh:
    flat = rectangle(n_around, 3)
    column, row = np.divmod(np.arange(len(flat.vertices)), 4)
    angle = 2 * np.pi * column / n_around
    places = np.stack([(2 + row) * np.cos(angle), (2 + row) * np.sin(angle), 0 * angle], axis=1)
    return TriangleMesh(places, flat.triangles % (4 * n_around))


def cones_sharing_their_tip(n_sides: int = 7) -> TriangleMesh:
    """Two disks with one vertex in common."""
    rim = np.arange(1, n_sides + 1)
    fan = np.stack([0 * rim, rim, np.roll(rim, -1)], axis=1)
    other = np.where(fan == 0, 0, fan + n_sides)
    return TriangleMesh(np.random.default_rng(0).normal(size=(2 * n_sides + 1, 3)), np.concatenate([fan, other]))


def three_sheets_on_an_edge(n: int = 5) -> TriangleMesh:
    """Three rectangles that have one whole side in common, like a book of three pages."""
    page = rectangle(n, n)
    on_spine = page.vertices[:, 1] == 0
    number, triangles = np.arange(len(on_spine)), [page.triangles]
    for k in (1, 2):
        triangles.append(np.where(on_spine[page.triangles], page.triangles, number[page.triangles] + k * len(on_spine)))
    return TriangleMesh(np.random.default_rng(0).normal(size=(3 * len(on_spine), 3)), np.concatenate(triangles))


def sphere_with_a_wall() -> TriangleMesh:
    """A sphere whose equator is filled with a disk: three triangles at every edge of the equator, two chambers."""
    vertices = np.array(
        [[0, 0, 1], [0, 0, -1], *[[np.cos(a), np.sin(a), 0] for a in np.arange(8) * np.pi / 4], [0, 0, 0]]
    )
    rim = np.arange(2, 10)
    fans = [np.stack([np.full(8, tip), rim, np.roll(rim, -1)], axis=1) for tip in (0, 1, 10)]
    return TriangleMesh(vertices, np.concatenate(fans))


def projective_plane() -> TriangleMesh:
    """The six-vertex triangulation; as a complex, its places in space have no meaning."""
    triangles = ["012", "023", "034", "045", "051", "124", "235", "341", "452", "513"]
    return TriangleMesh(np.random.default_rng(0).normal(size=(6, 3)), [[int(c) for c in t] for t in triangles])
