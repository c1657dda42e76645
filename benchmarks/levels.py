"""Linear eigenfunctions by way of coarser levels against those of one factor: the same parts, and in what time.

usage: python -m benchmarks.levels [--data DIR] [--sizes 50000 200000] [--noise 0 0.2] [--every 1]

One mesh of every character is divided, each triangle into four, up to the first number of vertices that is not below a
size by more than half, as it is and with every vertex moved by noise, in units of the mean edge. Both are analyzed with
linear elements, whatever their error. Agreement is the share of the area on which the best one-to-one matching of parts
gives the same part; finer levels are those beyond the default one that keep features of 1 % of the range. The limits of
the levels were chosen on every other character. Meshes whose loose parts leave less to be analyzed than levels are
taken for are left out. Without a folder the example characters alone are measured.
"""

import argparse
import platform
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import scipy

from benchmarks.elements import CHARACTERS, files, finer_levels, same_parts
from benchmarks.spectrum_solvers import subdivide
from compute import Analysis, TriangleMesh, analyze
from compute.errors import EngineError
from compute.fem import elements_by_need
from compute.fem.eigensolver import linear_eigenpairs
from compute.fem.multilevel_eigenpairs import LEAST_UNKNOWNS, multilevel_eigenpairs

LEAST_VERTICES = 400
ENOUGH = 0.995


@dataclass(frozen=True)
class Row:
    """A mesh, and how far the parts from levels are those from one factor."""

    character: str
    size: int
    noise: float
    n_vertices: int
    default: float
    finer: float
    values: float
    cpu_factor: float
    cpu_levels: float


def main() -> int:
    """Print the tables as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path)
    parser.add_argument("--sizes", type=int, nargs="+", default=[50_000, 200_000], help="vertices")
    parser.add_argument("--noise", type=float, nargs="+", default=[0.0, 0.2], help="in units of the mean edge")
    parser.add_argument("--every", type=int, default=1, help="of how many pairs of characters one is measured")
    options = parser.parse_args()
    sys.stdout.write(f"numpy {np.__version__}, scipy {scipy.__version__}, Python {platform.python_version()}\n\n")
    rows = []
    for number, (character, mesh) in enumerate(_characters(options.data)):
        if number // 2 % options.every:
            continue
        for size in options.sizes:
            for noise in options.noise:
                row = _measured(character, _noisy(_divided(mesh, size), noise), size, noise)
                if row is not None:
                    rows.append(row)
                    sys.stderr.write(f"{row}\n")
    sys.stdout.write(_table(rows) + "\n" + _below(rows))
    return 0


def _characters(data: Path | None) -> Iterator[tuple[str, TriangleMesh]]:
    for name, make in CHARACTERS.items():
        character = make(8000)
        yield f"examples/{name}", TriangleMesh(character.vertices, character.triangles)
    known = set()
    for _, character, _, mesh in files(data) if data else ():
        if character not in known and len(mesh.vertices) >= LEAST_VERTICES:
            known.add(character)
            yield character, mesh


def _divided(mesh: TriangleMesh, size: int) -> TriangleMesh:
    while len(mesh.vertices) < size / 2:
        mesh = subdivide(mesh)
    return mesh


def _noisy(mesh: TriangleMesh, noise: float) -> TriangleMesh:
    sides = np.linalg.norm(np.diff(mesh.vertices[mesh.edges.vertices], axis=1), axis=2)
    moves = np.random.default_rng(0).standard_normal(mesh.vertices.shape)
    return TriangleMesh(mesh.vertices + noise * sides.mean() * moves, mesh.triangles)


def _measured(character: str, mesh: TriangleMesh, size: int, noise: float) -> Row | None:
    try:
        (factored, cpu_factor), (leveled, cpu_levels) = (
            _timed(mesh, solve) for solve in (linear_eigenpairs, multilevel_eigenpairs)
        )
    except (EngineError, np.linalg.LinAlgError) as error:
        sys.stdout.write(f"No levels: {character}, {len(mesh.vertices)} vertices, noise {noise:g}: {error}\n")
        return None
    if len(factored.surface.mesh.used) < LEAST_UNKNOWNS:
        return None
    levels = finer_levels(factored)
    same = [same_parts(leveled, factored, level) for level in (factored.hierarchy.default_level, *levels)]
    n_shared = min(len(analysis.eigenbasis.values) for analysis in (factored, leveled))
    ratios = leveled.eigenbasis.values[:n_shared] / factored.eigenbasis.values[:n_shared]
    return Row(
        *(character, size, noise, len(mesh.vertices), same[0], float(np.mean(same[1:] or same))),
        *(float(np.abs(ratios - 1).max()), cpu_factor, cpu_levels),
    )


def _timed(mesh: TriangleMesh, solve: Callable[..., Any]) -> tuple[Analysis, float]:
    """Return an analysis whose linear functions come from one solver, and the seconds that it took for them."""
    seconds = []

    def measured(*arguments: Any) -> Any:
        start = time.process_time()
        try:
            return solve(*arguments)
        finally:
            seconds.append(time.process_time() - start)

    with mock.patch.multiple(elements_by_need, linear_pairs=measured, LARGEST_EXCESS=np.inf, LEAST_VERTICES=0):
        # Without what an analysis before has kept on the mesh.
        return analyze(TriangleMesh(mesh.vertices, mesh.triangles)), seconds[0]


def _table(rows: list[Row]) -> str:
    lines = [
        "| half | size | noise | meshes | default, mean | least | finer, mean | least | values to | CPU s, factor "
        "| levels |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    characters = sorted({row.character for row in rows})
    for half, members in (("chosen on", characters[::2]), ("judged on", characters[1::2])):
        for size, noise in sorted({(row.size, row.noise) for row in rows}):
            some = [row for row in rows if row.character in members and (row.size, row.noise) == (size, noise)]
            if some:
                lines.append(f"| {half} | {size:,} | {noise:g} | {len(some)} | {_summary(some)} |")
    return "\n".join(lines) + "\n"


def _summary(rows: list[Row]) -> str:
    shares = [[getattr(row, name) for row in rows] for name in ("default", "finer")]
    seconds = [sum(getattr(row, name) for row in rows) for name in ("cpu_factor", "cpu_levels")]
    cells = [f"{value:.2%}" for column in shares for value in (np.mean(column), min(column))]
    return " | ".join([*cells, f"{max(row.values for row in rows):.0e}", *(f"{value:.1f}" for value in seconds)])


def _below(rows: list[Row]) -> str:
    lines = [
        f"- {row.character}, {row.n_vertices} vertices, noise {row.noise:g}: {row.default:.2%}, finer {row.finer:.2%}"
        for row in rows
        if min(row.default, row.finer) < ENOUGH
    ]
    return "\n".join([f"The same on less than {ENOUGH:.1%} of the area:\n", *lines]) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
