"""Surfaces to match: lumpy balls with or without a plane of symmetry, and copies of them."""

import numpy as np
from scipy.spatial import Delaunay

from compute.analysis.analysis import Analysis
from compute.analysis.analyze import analyze
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere

# Direction, height and width of the lumps of a ball that looks like nothing else: no symmetry, no equal lumps.
LUMPS = (((0, 0, 1), 1.2, 0.45), ((1, 0, 0.2), 0.8, 0.4), ((-0.4, 1, -0.3), 0.6, 0.35), ((-0.3, -0.8, 0.5), 0.9, 0.3))
# A head and a tail on the plane x = 0, and a pair of limbs on either side of it.
PAIRED_LUMPS = (
    *(((0, 1, 0.3), 1.0, 0.4), ((0, -1, 0.5), 1.4, 0.25)),
    *(((side * 0.9, 0.5, -0.6), 1.2, 0.25) for side in (-1, 1)),
    *(((side * 0.7, -0.8, -0.6), 0.8, 0.3) for side in (-1, 1)),
)


def lumpy_ball(n_subdivisions: int = 3, lumps: tuple = LUMPS) -> TriangleMesh:
    """Return a sphere with lumps of Gaussian profile."""
    sphere = icosphere(n_subdivisions)
    radius = np.ones(len(sphere.vertices))
    for direction, height, width in lumps:
        away = 1 - sphere.vertices @ (np.array(direction) / np.linalg.norm(direction))
        radius += height * np.exp(-away / width**2)
    return TriangleMesh(sphere.vertices * radius[:, None], sphere.triangles)


def flat_strip(seed: int) -> TriangleMesh:
    """Return a rectangle, half as long again as wide, of random triangles: it fits itself turned by half a turn."""
    random = np.random.default_rng(seed)
    sides = np.linspace(0, 1, 12)
    border = [(x, y) for x in sides for y in sides if {x, y} & {0.0, 1.0}]
    places = np.vstack([border, random.uniform(0.02, 0.98, (200, 2))]) * [1.5, 1]
    return TriangleMesh(np.column_stack([places, np.zeros(len(places))]), Delaunay(places).simplices)


def shuffled(mesh: TriangleMesh, seed: int = 0) -> tuple[TriangleMesh, np.ndarray]:
    """Return the mesh in random order, and for each of its vertices the one it was."""
    random = np.random.default_rng(seed)
    order = random.permutation(len(mesh.vertices))
    triangles = np.argsort(order)[mesh.triangles][random.permutation(len(mesh.triangles))]
    return TriangleMesh(mesh.vertices[order], np.roll(triangles, 1, axis=1)), order


def moved(mesh: TriangleMesh) -> TriangleMesh:
    """Return the mesh turned, shifted and seven times as large."""
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    return TriangleMesh(7 * mesh.vertices @ turn.T + [3, -5, 2], mesh.triangles)


def mirror_image(mesh: TriangleMesh) -> TriangleMesh:
    """Return the mesh reflected in the plane x = 0, wound outward again."""
    return TriangleMesh(mesh.vertices * [-1, 1, 1], mesh.triangles[:, ::-1])


def quick(mesh: TriangleMesh) -> Analysis:
    """Return an analysis as far as matching needs it, which has functions of its own."""
    return analyze(mesh, n_functions=2, order=1)


def landed_vertices(matching, source, target) -> np.ndarray:
    """Return the source's node that each vertex of the target lands on."""
    here, there = spectral_shape(source.matching_basis), spectral_shape(target.matching_basis)
    of_vertex = there.functions[np.argsort(there.node)][: len(target.mesh.vertices)]
    return here.node[nearest_points(with_constant(matching.map), here.functions, of_vertex)]
