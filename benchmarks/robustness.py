"""How far the same parts are found again: under noise, on other triangulations, in other poses (paper, section 5.3).

usage: python -m benchmarks.robustness --data DIR [--mode nested]

Every shape is divided at its default level. Two divisions agree on the share of the area on which the best one-to-one
matching of their parts, the body among them, gives the same part; whatever is not matched is wrong. Noise is Gaussian,
along the normals, its standard deviation a fraction of the mean edge length. Remeshed copies have even triangles,
decimated ones 60 % of the triangles, finer ones four times as many.
"""

import argparse
import platform
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy
from scipy.optimize import linear_sum_assignment

from benchmarks.posed_families import closest_points, decimated, load_family, remeshed, shuffled
from compute import TriangleMesh, analyze
from compute.surface.mesh import Floats, Ints
from examples import humanoid

FAMILIES = ("makehuman", "wolf", "hand")
NOISE = (0.1, 0.2, 0.3, 0.4, 0.5)
# Vertices of the copies with even triangles.
REMESHED = (3000, 6000, 12000)


@dataclass(frozen=True, eq=False)
class Divided:
    """A shape at its default level."""

    name: str
    mesh: TriangleMesh
    labels: Ints
    n_parts: int


@dataclass(frozen=True, eq=False)
class Row:
    """One comparison: what was done to the shape, and the share of area on which the parts agree."""

    shape: str
    change: str
    name: str
    n_parts: int
    agreement: float


def main() -> int:
    """Print the tables as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--mode", choices=("nested", "features"), default="nested")
    options = parser.parse_args()
    sys.stdout.write(f"numpy {np.__version__}, scipy {scipy.__version__}, Python {platform.python_version()}\n\n")
    rows = []
    for shape, poses in _shapes(options.data):
        rows += list(_compared(shape, poses, options.mode))
        sys.stdout.flush()
    sys.stdout.write(_table(rows))
    return 0


def agreement(first: Ints, second: Ints, weight: Floats) -> float:
    """Return the share of the weight on which two labellings agree after the best one-to-one matching."""
    _, first = np.unique(first, return_inverse=True)
    _, second = np.unique(second, return_inverse=True)
    common = np.zeros((first.max() + 1, second.max() + 1))
    np.add.at(common, (first, second), weight)
    return float(common[linear_sum_assignment(-common)].sum() / weight.sum())


def noisy(mesh: TriangleMesh, strength: float, seed: int = 0) -> TriangleMesh:
    """Return the mesh with its vertices moved along their normals; the strength is a fraction of the mean edge."""
    corners = mesh.vertices[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(mesh.vertices)
    np.add.at(normals, mesh.triangles, across[:, None])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    ends = mesh.vertices[mesh.edges.vertices]
    edge = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean()
    distance = strength * edge * np.random.default_rng(seed).normal(size=len(normals))
    return TriangleMesh(mesh.vertices + distance[:, None] * normals, mesh.triangles)


def finer(mesh: TriangleMesh) -> TriangleMesh:
    """Return the surface with each triangle divided into four, shuffled."""
    edges, n_vertices = mesh.edges, len(mesh.vertices)
    vertices = np.vstack([mesh.vertices, mesh.vertices[edges.vertices].mean(axis=1)])
    (a, b, c), (ab, bc, ca) = mesh.triangles.T, (n_vertices + edges.of_triangle).T
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return shuffled(TriangleMesh(vertices, np.concatenate([np.stack(part, axis=1) for part in parts])))


def _shapes(data: Path) -> Iterator[tuple[str, list[TriangleMesh]]]:
    """Yield each family with its poses, the rest pose first."""
    character = humanoid(10_000)
    poses = [character.vertices] + [character.mesh_in_pose(pose) for pose in character.poses if pose != "rest"]
    yield "humanoid", [TriangleMesh(pose, character.triangles) for pose in poses]
    for family in FAMILIES:
        found = load_family(data, family)
        if found:
            yield family, [pose.mesh for pose in found]
        else:
            sys.stdout.write(f"Skipped: there is no {family} in {data}.\n")


def _compared(shape: str, poses: list[TriangleMesh], mode: str) -> Iterator[Row]:
    rest = _divided("rest", poses[0], mode)
    yield Row(shape, "none", "rest", rest.n_parts, 1.0)
    for number, pose in enumerate(poses[1:], start=1):
        posed = _divided(f"pose {number}", pose, mode)
        share = agreement(rest.labels, posed.labels, rest.mesh.areas)
        yield Row(shape, "pose", posed.name, posed.n_parts, share)
    for name, copy in _copies(rest.mesh):
        divided = _divided(name, copy, mode)
        yield Row(shape, "remeshed", name, divided.n_parts, _agreement_on_copy(rest, divided))
    for strength in NOISE:
        divided = _divided(f"{strength} edges", noisy(rest.mesh, strength), mode)
        share = agreement(rest.labels, divided.labels, rest.mesh.areas)
        yield Row(shape, "noise", divided.name, divided.n_parts, share)


def _copies(mesh: TriangleMesh) -> Iterator[tuple[str, TriangleMesh]]:
    yield "decimated", decimated(mesh)
    for n_vertices in REMESHED:
        yield f"even, {n_vertices} vertices", remeshed(mesh, n_vertices)
    if len(mesh.vertices) <= max(REMESHED):
        yield "finer", finer(mesh)


def _divided(name: str, mesh: TriangleMesh, mode: str) -> Divided:
    segmentation = analyze(mesh).segment(mode=mode)
    return Divided(name, mesh, segmentation.labels.astype(np.int64), segmentation.n_parts)


def _agreement_on_copy(source: Divided, copy: Divided) -> float:
    """Return the agreement of a shape and another triangulation of it, whose triangles lie on its own."""
    centres = copy.mesh.vertices[copy.mesh.triangles].mean(axis=1)
    on_source = source.labels[closest_points(centres, source.mesh).triangle]
    return agreement(on_source, copy.labels, copy.mesh.areas)


def _table(rows: list[Row]) -> str:
    lines = ["| shape | change | | labels | same parts |", "|---|---|---|---|---|"]
    lines += [f"| {row.shape} | {row.change} | {row.name} | {row.n_parts} | {row.agreement:.1%} |" for row in rows]
    lines += ["", "| change | mean | least | rows |", "|---|---|---|---|"]
    for change in ("remeshed", "pose", "noise"):
        shares = [row.agreement for row in rows if row.change == change]
        if shares:
            lines.append(f"| {change} | {np.mean(shares):.1%} | {min(shares):.1%} | {len(shares)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
