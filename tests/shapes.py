"""Surfaces with known spectra."""

import numpy as np

from compute.surface.mesh import TriangleMesh


def subdivide(mesh: TriangleMesh) -> TriangleMesh:
    """Split every triangle into four, flat."""
    edges = mesh.edges
    middle = len(mesh.vertices) + edges.of_triangle
    vertices = np.vstack([mesh.vertices, mesh.vertices[edges.vertices].mean(axis=1)])
    (a, b, c), (ab, bc, ca) = mesh.triangles.T, middle.T
    corners = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return TriangleMesh(vertices, np.vstack([np.stack(triangle, axis=1) for triangle in corners]))


def tetrahedron(n_subdivisions: int = 0) -> TriangleMesh:
    """Return a regular tetrahedron with edges of length 1; flat triangles hold it exactly."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(8)
    mesh = TriangleMesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    for _ in range(n_subdivisions):
        mesh = subdivide(mesh)
    return mesh


def rectangle(n_long: int, n_short: int, width: float = 2.0, height: float = 1.0) -> TriangleMesh:
    """Return a flat rectangle of n_long by n_short cells, two triangles each."""
    x, y = np.meshgrid(np.linspace(0, width, n_long + 1), np.linspace(0, height, n_short + 1), indexing="ij")
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    triangles = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return TriangleMesh(np.stack([x, y, np.zeros_like(x)], axis=-1).reshape(-1, 3), triangles)


def icosphere(n_subdivisions: int = 0) -> TriangleMesh:
    """Return a sphere of radius 1 from a regular icosahedron."""
    golden = (1 + np.sqrt(5)) / 2
    pairs = [(a, b * golden) for a in (-1, 1) for b in (-1, 1)]
    vertices = np.array([np.roll([0, a, b], k) for k in range(3) for a, b in pairs])
    distance = np.linalg.norm(vertices[:, None] - vertices, axis=2)
    near = np.isclose(distance, 2.0)
    triples = [(i, j, k) for i in range(12) for j in range(i, 12) for k in range(j, 12)]
    faces = np.array([t for t in triples if near[t[0], t[1]] and near[t[1], t[2]] and near[t[0], t[2]]])
    a, b, c = vertices[faces].swapaxes(0, 1)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    faces[inward] = faces[inward][:, ::-1]
    mesh = TriangleMesh(vertices / np.linalg.norm(vertices[0]), faces)
    for _ in range(n_subdivisions):
        finer = subdivide(mesh)
        mesh = TriangleMesh(finer.vertices / np.linalg.norm(finer.vertices, axis=1)[:, None], finer.triangles)
    return mesh


def torus(n_around: int = 24, n_through: int = 12, radius: float = 3.0, thickness: float = 1.0) -> TriangleMesh:
    """Return a torus about the z axis, wound outward."""
    around, through = np.meshgrid(np.arange(n_around), np.arange(n_through), indexing="ij")
    u, v = 2 * np.pi * around / n_around, 2 * np.pi * through / n_through
    tube = radius + thickness * np.cos(v)
    points = np.stack([tube * np.cos(u), tube * np.sin(u), thickness * np.sin(v)], axis=-1)
    number = around * n_through + through
    right, up = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    triangles = np.concatenate(
        [np.stack(t, axis=-1).reshape(-1, 3) for t in ((number, right, both), (number, both, up))]
    )
    return TriangleMesh(points.reshape(-1, 3), triangles)


def star(n_arms: int = 5, n_subdivisions: int = 4, length: float = 1.5, growth: float = 0.1) -> TriangleMesh:
    """Return a sphere with tapering arms in the plane z = 0, the first along x, each longer than the one before."""
    sphere = icosphere(n_subdivisions)
    x, y, _ = sphere.vertices.T
    radius = np.ones(len(x))
    for arm in range(n_arms):
        angle = 2 * np.pi * arm / n_arms
        along = x * np.cos(angle) + y * np.sin(angle)
        radius += length * (1 + growth * arm) * np.exp(-12 * (1 - along))
    return TriangleMesh(sphere.vertices * radius[:, None], sphere.triangles)


def joined(*meshes: TriangleMesh) -> TriangleMesh:
    """Return the meshes as loose parts of one."""
    offsets = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    triangles = [mesh.triangles + offset for mesh, offset in zip(meshes, offsets, strict=False)]
    return TriangleMesh(np.vstack([mesh.vertices for mesh in meshes]), np.vstack(triangles))


def lathe(profile: np.ndarray, n_around: int) -> TriangleMesh:
    """Turn a line of distances from the z axis and heights (n, 2) around the axis; ends on the axis are closed.

    Walked along from the bottom up, the outside is on the right.
    """
    angle = 2 * np.pi * np.arange(n_around) / n_around
    around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rings = [np.column_stack([radius * around, np.full(n_around, height)]) for radius, height in profile]
    column = np.arange(n_around)
    after = np.roll(column, -1)
    triangles = []
    for low in range(len(profile) - 1):
        corners = [low * n_around + column, low * n_around + after, (low + 1) * n_around + after]
        triangles += [corners, [corners[0], corners[2], (low + 1) * n_around + column]]
    triangles = np.concatenate([np.stack(corners, axis=1) for corners in triangles])
    # All vertices of a ring at one place are one.
    places, vertex = np.unique(np.round(np.vstack(rings), 9), axis=0, return_inverse=True)
    corners = vertex.reshape(-1)[triangles]
    is_whole = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    return TriangleMesh(places, corners[is_whole])
