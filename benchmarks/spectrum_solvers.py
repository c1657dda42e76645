"""The solvers that `benchmarks.spectrum` compares, and the meshes it compares them on.

Run as a program, it solves one problem with one solver and prints what came out and what it cost as JSON.
"""

import json
import platform
import resource
import sys
import time
from pathlib import Path

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from benchmarks.peers import versions_of
from compute.fem.assembly import mass_matrix, stiffness_matrix
from compute.fem.eigenbasis import solve_eigenbasis
from compute.fem.space import function_space
from compute.surface.mesh import Floats, TriangleMesh

SHIFT = -4.0


def _ours(order: int):
    return lambda mesh, n_pairs: solve_eigenbasis(mesh, n_pairs, order=order).values


def plain_scipy(mesh: TriangleMesh, n_pairs: int) -> Floats:
    """Return eigenvalues from `eigsh` with its defaults, on our cubic matrices."""
    space = function_space(mesh, 3)
    start = np.random.default_rng(0).standard_normal(space.n_unknowns)
    values, _ = eigsh(stiffness_matrix(space).tocsc(), n_pairs + 1, mass_matrix(space).tocsc(), sigma=SHIFT, v0=start)
    return np.sort(values)[1:] / mesh.areas.sum()


def cholespy(mesh: TriangleMesh, n_pairs: int) -> Floats:
    """Return eigenvalues from `eigsh` with the Cholesky factor of cholespy (CHOLMOD), on our cubic matrices."""
    from cholespy import CholeskySolverD, MatrixType

    space = function_space(mesh, 3)
    stiffness, mass = stiffness_matrix(space), mass_matrix(space)
    operator = (stiffness - SHIFT * mass).tocoo()
    n = space.n_unknowns
    factor = CholeskySolverD(
        n, operator.row.astype(np.int32), operator.col.astype(np.int32), operator.data, MatrixType.COO
    )

    def solve(column: Floats) -> Floats:
        result = np.zeros(n)
        factor.solve(np.ascontiguousarray(column), result)
        return result

    inverse = LinearOperator((n, n), matvec=solve, dtype=np.float64)
    start = np.random.default_rng(0).standard_normal(n)
    values, _ = eigsh(stiffness, n_pairs + 1, mass, sigma=SHIFT, OPinv=inverse, v0=start)
    return np.sort(values)[1:] / mesh.areas.sum()


def lapy(mesh: TriangleMesh, n_pairs: int) -> Floats:
    """Return eigenvalues from LaPy's linear elements with its default solver."""
    import lapy as library

    surface = library.TriaMesh(mesh.vertices, mesh.triangles.astype(np.int32))
    values, _ = library.Solver(surface).eigs(n_pairs + 1)
    return np.sort(values)[1:]


SOLVERS = {
    "cubic": _ours(3),
    "quadratic": _ours(2),
    "linear": _ours(1),
    "scipy": plain_scipy,
    "cholespy": cholespy,
    "lapy": lapy,
}


def versions() -> str:
    """Return a line that says what was measured on what."""
    found = versions_of("numpy", "scipy", "lapy", "cholespy")
    return f"Python {platform.python_version()}, {found}, one BLAS thread, {platform.machine()}"


def subdivide(mesh: TriangleMesh) -> TriangleMesh:
    """Split every triangle into four, flat."""
    edges = mesh.edges
    middle = len(mesh.vertices) + edges.of_triangle
    vertices = np.vstack([mesh.vertices, mesh.vertices[edges.vertices].mean(axis=1)])
    (a, b, c), (ab, bc, ca) = mesh.triangles.T, middle.T
    corners = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return TriangleMesh(vertices, np.vstack([np.stack(triangle, axis=1) for triangle in corners]))


def tetrahedron(n_subdivisions: int) -> TriangleMesh:
    """Return a regular tetrahedron with edges of length 1."""
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) / np.sqrt(8)
    mesh = TriangleMesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    for _ in range(n_subdivisions):
        mesh = subdivide(mesh)
    return mesh


def bumpy_sphere(n_vertices: int) -> TriangleMesh:
    """Return a sphere with bumps: points on a spiral, joined to their Delaunay triangles, moved in and out."""
    from scipy.spatial import ConvexHull

    i = np.arange(n_vertices) + 0.5
    z, angle = 1 - 2 * i / n_vertices, np.pi * (1 + np.sqrt(5)) * i
    points = np.stack([np.sqrt(1 - z**2) * np.cos(angle), np.sqrt(1 - z**2) * np.sin(angle), z], axis=1)
    triangles = ConvexHull(points).simplices.astype(np.int64)
    a, b, c = points[triangles].swapaxes(0, 1)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    x, y, z = points.T
    radius = 1 + 0.3 * np.sin(3 * x + y) * np.cos(2 * y + 1) + 0.2 * z**3
    return TriangleMesh(points * radius[:, None], triangles)


def read_obj(path: Path) -> TriangleMesh:
    """Return the faces of an .obj file, split into triangles."""
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        kind, *fields = line.split() or [""]
        if kind == "v":
            vertices.append([float(field) for field in fields[:3]])
        elif kind == "f":
            corners = [int(field.split("/")[0]) - 1 for field in fields]
            triangles += [[corners[0], *corners[k : k + 2]] for k in range(1, len(corners) - 1)]
    return TriangleMesh(np.array(vertices), np.array(triangles))


def main(solver: str, path: str, n_pairs: str) -> None:
    """Solve one problem and print the outcome as JSON."""
    with np.load(path) as arrays:
        mesh = TriangleMesh(arrays["vertices"], arrays["triangles"])
    SOLVERS[solver](tetrahedron(1), 3)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    cpu, wall = time.process_time(), time.perf_counter()
    values = SOLVERS[solver](mesh, int(n_pairs))
    costs = {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    print(json.dumps({"values": values.tolist(), "peak": peak, **costs}))


if __name__ == "__main__":
    main(*sys.argv[1:])
