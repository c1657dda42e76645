"""Topology against GUDHI: critical points, pairs and levels of a field, and the pairs alone of GUDHI.

usage: python -m benchmarks.topology [--largest N]

The net is the humanoid's, refined 9 for 1 as for cubic elements; the smooth field is a sum of waves through space, the
noisy one independent random values. "ours" starts from values and triangles and ends with critical points, both merge
trees, the pairs and the trees that every level is read from; GUDHI's time is that of ``compute_persistence`` on a
filtration already built. CPU seconds, minimum of three, alternated.
"""

import argparse
import sys
import time
from collections.abc import Callable
from importlib.metadata import version

import numpy as np

from compute import TriangleMesh
from compute.fem.lagrange import reference_element
from compute.fem.space import function_space
from compute.msc.links import links_of
from compute.msc.morse_smale import FieldTopology
from compute.segmentation.hierarchy.levels import build_hierarchy
from compute.surface.mesh import Floats
from examples import humanoid

# Vertices of the meshes; a closed net of cubic elements has 9 times as many.
SIZES = (4_000, 10_000, 20_000, 50_000)
REPEATS = 3


def main() -> int:
    """Print the table as Markdown."""
    import gudhi

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="most vertices of a mesh")
    largest = parser.parse_args().largest
    lines = [
        f"gudhi {gudhi.__version__}, numpy {np.__version__}, scipy {version('scipy')}; seconds\n",
        "| net vertices | field | critical | links | critical points | pairs and levels | ours | gudhi | ratio |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for n_vertices in (size for size in SIZES if size <= largest):
        mesh = cubic_net(humanoid(n_vertices))
        for name, field in (("smooth", waves), ("noisy", noise)):
            lines.append(_row(mesh, name, field(mesh)))
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


def cubic_net(character) -> TriangleMesh:
    """Return the triangles between the nodes of cubic elements."""
    mesh = TriangleMesh(character.vertices, character.triangles)
    space, element = function_space(mesh, 3), reference_element(3)
    return TriangleMesh(space.nodes, space.elements[:, element.subdivision].reshape(-1, 3))


def waves(mesh: TriangleMesh) -> Floats:
    """Return a smooth field with some tens of critical points."""
    random = np.random.default_rng(0)
    places = mesh.vertices / np.ptp(mesh.vertices, axis=0).max()
    return np.sin(places @ random.normal(size=(3, 6)) * 6 + random.uniform(0, 6, 6)) @ random.normal(size=6)


def noise(mesh: TriangleMesh) -> Floats:
    """Return a field of which every other vertex is critical."""
    return np.random.default_rng(0).normal(size=len(mesh.vertices))


def _row(mesh: TriangleMesh, name: str, values: Floats) -> str:
    ours, theirs = np.full((REPEATS, 3), np.inf), np.full(REPEATS, np.inf)
    for repeat in range(REPEATS):
        ours[repeat], n_critical = _ours(mesh, values)
        theirs[repeat] = _seconds(_filtration(mesh, values).compute_persistence)[0]
    best, theirs_best = ours[ours.sum(axis=1).argmin()], theirs.min()
    figures = [*best, best.sum(), theirs_best]
    seconds = " | ".join(f"{figure:.3f}" for figure in figures)
    ratio = best.sum() / theirs_best
    return f"| {len(mesh.vertices)} | {name} | {n_critical} | {seconds} | {ratio:.2f} |"


def _ours(mesh: TriangleMesh, values: Floats) -> tuple[list[float], int]:
    links = links_of(mesh.triangles, len(mesh.vertices))
    making, _ = _seconds(lambda: links.is_plain)
    topology = FieldTopology(links, mesh.vertices, values)
    finding, points = _seconds(lambda: topology.critical_points)
    pairing, _ = _seconds(lambda: build_hierarchy(topology, minima_are_features=True))
    return [making, finding, pairing], len(points.vertex)


def _filtration(mesh: TriangleMesh, values: Floats):
    import gudhi

    tree = gudhi.SimplexTree()
    sides, corners = mesh.edges.vertices, mesh.triangles
    tree.insert_batch(np.arange(len(values), dtype=np.int32)[None], values)
    tree.insert_batch(sides.T.astype(np.int32), values[sides].max(axis=1))
    tree.insert_batch(corners.T.astype(np.int32), values[corners].max(axis=1))
    return tree


def _seconds(work: Callable):
    start = time.process_time()
    result = work()
    return time.process_time() - start, result


if __name__ == "__main__":
    raise SystemExit(main())
