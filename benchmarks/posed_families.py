"""Characters in several poses with one connectivity, and remeshed copies that keep the true correspondence."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from compute.fem.lagrange import reference_element
from compute.registration.dense.surface_points import nearest_in_triangles
from compute.surface.mesh import Floats, Ints, TriangleMesh, connected_pieces

# Folder and stem of the files; the poses of a family share vertices and faces.
FAMILIES = {
    "makehuman": ("makehuman", "mh_body_?_*.obj"),
    **{name: ("quaternius-animals", f"{name}_?_*.off") for name in ("horse", "donkey", "fox", "wolf", "husky")},
    "shiba": ("quaternius-animals", "shibainu_?_*.off"),
    "trex": ("quaternius-dinosaurs", "trex_?_*.off"),
    "velociraptor": ("quaternius-dinosaurs", "velociraptor_?_*.off"),
    "cesium-man": ("cesium-man", "cesiumman_?_*.off"),
    "hand": ("webxr-hand", "hand_?_*.off"),
}
# Copies are remeshed to this many vertices, or decimated to this share of their triangles.
REMESHED_VERTICES = 5000
DECIMATED_SHARE = 0.6
# Places of a mesh whose triangles are looked at for the nearest point.
NEAR_PLACES = 8


@dataclass(frozen=True, eq=False)
class Pose:
    """A mesh of a family."""

    family: str
    name: str
    mesh: TriangleMesh


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on a triangle mesh: triangle (n,) and barycentric coordinates (n, 3)."""

    triangle: Ints
    barycentric: Floats

    def on(self, mesh: TriangleMesh) -> Floats:
        """Return (n, 3) where the points lie on a mesh of the same connectivity."""
        return np.einsum("nk,nkj->nj", self.barycentric, mesh.vertices[mesh.triangles[self.triangle]])


def load_family(data: Path, family: str) -> list[Pose]:
    """Return the poses of a family, the rest pose first; empty where the folder is absent."""
    folder, pattern = FAMILIES[family]
    return [Pose(family, path.stem, read_mesh(path)) for path in sorted((data / folder).glob(pattern))]


def read_mesh(path: Path) -> TriangleMesh:
    """Read an .obj or .off file; polygons are cut into fans."""
    vertices, polygons = _read_obj(path) if path.suffix == ".obj" else _read_off(path)
    fans = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    return TriangleMesh(np.array(vertices, dtype=float), np.array(fans))


def _read_obj(path: Path) -> tuple[list, list]:
    rows = [line.split() for line in path.read_text().splitlines()]
    vertices = [list(map(float, row[1:4])) for row in rows if row[:1] == ["v"]]
    return vertices, [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]


def _read_off(path: Path) -> tuple[list, list]:
    lines = (line.split("#")[0].split() for line in path.read_text().splitlines())
    rows = [row for row in lines if row]
    counts = rows[0][1:] if len(rows[0]) > 1 else rows.pop(1)
    n_vertices, n_faces = int(counts[0]), int(counts[1])
    vertices = [list(map(float, row[:3])) for row in rows[1 : 1 + n_vertices]]
    return vertices, [list(map(int, row[1 : 1 + int(row[0])])) for row in rows[1 + n_vertices :][:n_faces]]


def remeshed(mesh: TriangleMesh, n_vertices: int = REMESHED_VERTICES) -> TriangleMesh:
    """Return the surface with new, even triangles, shuffled."""
    work = _meshset(mesh)
    import pymeshlab

    # A triangulation of even triangles with edge e has about area / (0.87 e^2) vertices.
    edge = np.sqrt(mesh.areas.sum() / (0.87 * n_vertices))
    work.meshing_isotropic_explicit_remeshing(targetlen=pymeshlab.PureValue(edge), iterations=6)
    return shuffled(_mesh_of(work))


def decimated(mesh: TriangleMesh, share: float = DECIMATED_SHARE) -> TriangleMesh:
    """Return the surface with a share of its triangles, shuffled."""
    work = _meshset(mesh)
    target = int(share * len(mesh.triangles))
    work.meshing_decimation_quadric_edge_collapse(targetfacenum=target, preservetopology=True)
    return shuffled(_mesh_of(work))


def noised(mesh: TriangleMesh) -> TriangleMesh:
    """Return the mesh with vertices moved at random by about an eighth of an edge, shuffled."""
    corners = mesh.vertices[mesh.triangles]
    edge = np.linalg.norm(corners[:, 0] - corners[:, 1], axis=1).mean()
    shift = np.random.default_rng(1).normal(size=mesh.vertices.shape)
    return shuffled(TriangleMesh(mesh.vertices + 0.15 * edge * shift, mesh.triangles))


def cut_open(mesh: TriangleMesh) -> TriangleMesh:
    """Return the remeshed surface without 3 % of its triangles around a random one, in one piece."""
    even = remeshed(mesh)
    centre = even.vertices[even.triangles].mean(axis=1)
    away = np.linalg.norm(centre - centre[np.random.default_rng(2).integers(len(centre))], axis=1)
    left = TriangleMesh(even.vertices, even.triangles[away > np.quantile(away, 0.03)])
    ends = left.edges.vertices.T
    piece = connected_pieces(*ends, len(left.vertices))[left.triangles[:, 0]]
    kept = left.triangles[piece == np.bincount(piece).argmax()]
    used, corner = np.unique(kept, return_inverse=True)
    return TriangleMesh(left.vertices[used], corner.reshape(-1, 3))


def shuffled(mesh: TriangleMesh, seed: int = 0) -> TriangleMesh:
    """Return the mesh with vertices, triangles and first corners in random order."""
    random = np.random.default_rng(seed)
    order = random.permutation(len(mesh.vertices))
    triangles = np.argsort(order)[mesh.triangles][random.permutation(len(mesh.triangles))]
    turn = (np.arange(3) + random.integers(3, size=(len(triangles), 1))) % 3
    return TriangleMesh(mesh.vertices[order], np.take_along_axis(triangles, turn, axis=1))


def closest_points(points: Floats, mesh: TriangleMesh) -> SurfacePoints:
    """Return the nearest point of a mesh to each point, sought in the triangles that lie around the nearest places."""
    lattice = reference_element(3).barycentric
    corners = mesh.vertices[mesh.triangles]
    places = (lattice @ corners).reshape(-1, 3)
    near = cKDTree(places).query(points, NEAR_PLACES)[1] // len(lattice)
    found = [nearest_in_triangles(points, corners[near[:, k]]) for k in range(NEAR_PLACES)]
    barycentric, away = (np.stack(values, axis=1) for values in zip(*found, strict=True))
    best = away.argmin(axis=1)
    row = np.arange(len(points))
    return SurfacePoints(near[row, best], barycentric[row, best])


@dataclass(frozen=True, eq=False)
class Mirror:
    """The plane of symmetry of a family, found on its rest pose."""

    axis: int
    place: float

    def reflected(self, points: Floats) -> Floats:
        """Return the mirror images of points."""
        images = points.copy()
        images[:, self.axis] = 2 * self.place - images[:, self.axis]
        return images


def find_mirror(rest: TriangleMesh) -> Mirror:
    """Return the coordinate plane through the middle in which the rest pose is most symmetric."""
    middle = (rest.vertices.min(axis=0) + rest.vertices.max(axis=0)) / 2
    mirrors = [Mirror(axis, float(middle[axis])) for axis in range(3)]
    tree = cKDTree(rest.vertices)
    return min(mirrors, key=lambda mirror: tree.query(mirror.reflected(rest.vertices))[0].mean())


def _meshset(mesh: TriangleMesh):
    import pymeshlab

    work = pymeshlab.MeshSet(verbose=False)
    work.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.triangles))
    return work


def _mesh_of(work) -> TriangleMesh:
    current = work.current_mesh()
    return TriangleMesh(current.vertex_matrix(), current.face_matrix())
