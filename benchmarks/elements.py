"""Parts of linear elements against those of cubic ones: where they are the same, and what `order="auto"` takes.

usage: python -m benchmarks.elements [--data DIR] [--largest 30000]

Every mesh is analyzed with both. The estimate is the largest relative error of an eigenvalue as the linear functions
tell it, by which "auto" chooses. Agreement is the share of the area on which the best one-to-one matching of parts
gives the same part; finer levels are those beyond the default one that keep features of 1 % of the range. Every other
character is in the half on which the limit was chosen. Without a folder the example characters alone are measured.
"""

import argparse
import platform
import re
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy

from benchmarks.posed_families import read_mesh
from benchmarks.robustness import agreement
from compute import Analysis, TriangleMesh, analyze
from compute.errors import EngineError
from compute.fem.assembly import metric
from compute.fem.eigensolver import EigenProblem
from compute.fem.elements_by_need import LARGEST_EXCESS, LEAST_VERTICES
from compute.fem.linear_error import relative_excess
from compute.fem.space import function_space
from examples import hand, humanoid, octopus, quadruped

CHARACTERS = {"hand": hand, "humanoid": humanoid, "octopus": octopus, "quadruped": quadruped}
SIZES = (2000, 4000, 8000)
LEAST_FEATURE = 0.01
# Ends of the ranges of the estimate, the limit of "auto" among them.
RANGES = (LARGEST_EXCESS / 2, LARGEST_EXCESS, 2 * LARGEST_EXCESS, 4 * LARGEST_EXCESS, np.inf)
ENOUGH = 0.995


@dataclass(frozen=True)
class Row:
    """A mesh: its family and character, and how far its linear parts are its cubic ones."""

    family: str
    character: str
    name: str
    n_vertices: int
    estimate: float
    default: float
    finer: float
    cpu_linear: float
    cpu_cubic: float

    @property
    def is_linear(self) -> bool:
        """Whether "auto" takes linear elements."""
        return self.n_vertices >= LEAST_VERTICES and self.estimate <= LARGEST_EXCESS


def main() -> int:
    """Print the tables as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path)
    parser.add_argument("--largest", type=int, default=30_000, help="vertices")
    options = parser.parse_args()
    sys.stdout.write(f"numpy {np.__version__}, scipy {scipy.__version__}, Python {platform.python_version()}\n\n")
    if options.data is None:
        sys.stdout.write("Without --data only the example characters are measured.\n\n")
    found = [*_examples(), *(files(options.data) if options.data else ())]
    rows = [row for place in found if (row := _measured(*place, options.largest)) is not None]
    sys.stdout.write(_by_estimate(rows) + "\n" + _by_family(rows) + "\n" + _below(rows))
    return 0


def _examples() -> Iterator[tuple[str, str, str, TriangleMesh]]:
    for name, make in CHARACTERS.items():
        for n_vertices in SIZES:
            try:
                character = make(n_vertices)
            except ValueError:
                continue  # Too few for its fingers.
            mesh = TriangleMesh(character.vertices, character.triangles)
            yield "examples", f"examples/{name}", f"{name} {n_vertices}", mesh


def files(data: Path) -> Iterator[tuple[str, str, str, TriangleMesh]]:
    """Yield family, character, name and mesh of every file below a folder that can be read."""
    for path in sorted((*data.rglob("*.off"), *data.rglob("*.obj"))):
        family = path.relative_to(data).parts[0]
        # Poses of a character, and scans of people, are told apart by numbers.
        character = f"{family}/{re.split(r'_[0-9]', path.stem)[0]}"
        try:
            mesh = read_mesh(path)
        except (ValueError, IndexError) as error:
            sys.stdout.write(f"Skipped: {path.name} cannot be read here ({error}).\n")
        else:
            yield family, character, path.stem, mesh


def _measured(family: str, character: str, name: str, mesh: TriangleMesh, largest: int) -> Row | None:
    if len(mesh.vertices) > largest:
        return None
    try:
        (linear, cpu_linear), (cubic, cpu_cubic) = (_timed(mesh, order) for order in (1, 3))
    except EngineError as error:
        sys.stdout.write(f"Skipped: {name}: {error}\n")
        return None
    levels = finer_levels(cubic)
    same = [same_parts(linear, cubic, level) for level in (cubic.hierarchy.default_level, *levels)]
    return Row(
        *(family, character, name, len(cubic.surface.mesh.used), _estimate(linear)),
        *(same[0], float(np.mean(same[1:] or same)), cpu_linear, cpu_cubic),
    )


def _timed(mesh: TriangleMesh, order: int) -> tuple[Analysis, float]:
    # Without what an analysis before has kept on the mesh.
    fresh = TriangleMesh(mesh.vertices, mesh.triangles)
    start = time.process_time()
    analysis = analyze(fresh, order=order)
    analysis.segment()
    return analysis, time.process_time() - start


def _estimate(linear: Analysis) -> float:
    basis, mesh = linear.eigenbasis, linear.surface.mesh
    space, area = function_space(mesh, 1), mesh.areas.sum()
    problem = EigenProblem(space, space.has_mass, metric(mesh), None)
    return float(relative_excess(problem, basis.values * area, basis.functions * np.sqrt(area)).max())


def finer_levels(cubic: Analysis) -> range:
    """Return the levels beyond the default one that keep features of 1 % of the range."""
    hierarchy = cubic.hierarchy
    return range(hierarchy.default_level + 1, hierarchy.level_of_threshold(LEAST_FEATURE) + 1)


def same_parts(linear: Analysis, cubic: Analysis, level: int) -> float:
    """Return the share of the area on which two analyses give the same part at a level of the second one."""
    own = linear.hierarchy.default_level if level == cubic.hierarchy.default_level else level
    own = min(own, linear.hierarchy.n_levels - 1)
    return agreement(linear.segment(level=own).labels, cubic.segment(level=level).labels, cubic.mesh.areas)


def _by_estimate(rows: list[Row]) -> str:
    characters = sorted({row.character for row in rows if row.n_vertices >= LEAST_VERTICES})
    lines = [
        f"Meshes of {LEAST_VERTICES} vertices and more:\n",
        "| half | estimate up to | meshes | default, mean | least | finer, mean | least |",
        "|---|---|---|---|---|---|---|",
    ]
    for half, members in (("chosen on", characters[::2]), ("judged on", characters[1::2])):
        below = 0.0
        for end in RANGES:
            some = [
                row
                for row in rows
                if row.character in members and row.n_vertices >= LEAST_VERTICES and below < row.estimate <= end
            ]
            lines.append(f"| {half} | {end:g} | {len(some)} | {_shares(some)} |")
            below = end
    return "\n".join(lines) + "\n"


def _by_family(rows: list[Row]) -> str:
    lines = [
        "| family | meshes | linear | default, mean | least | finer, mean | least | CPU s, linear | cubic |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    cubic = []
    for family in sorted({row.family for row in rows}):
        every = [row for row in rows if row.family == family]
        taken = [row for row in every if row.is_linear]
        if not taken:
            cubic.append(f"{family} ({len(every)})")
            continue
        seconds = [sum(getattr(row, name) for row in taken) for name in ("cpu_linear", "cpu_cubic")]
        lines.append(
            f"| {family} | {len(every)} | {len(taken)} | {_shares(taken)} | {seconds[0]:.1f} | {seconds[1]:.1f} |"
        )
    return "\n".join([*lines, "", f"Cubic elements for all meshes of {', '.join(cubic) or 'none'}."]) + "\n"


def _shares(rows: list[Row]) -> str:
    if not rows:
        return " | | | "
    columns = [[getattr(row, name) for row in rows] for name in ("default", "finer")]
    return " | ".join(f"{value:.2%}" for shares in columns for value in (np.mean(shares), min(shares)))


def _below(rows: list[Row]) -> str:
    lines = [
        f"- {row.family}, {row.name}: {row.default:.2%}, finer {row.finer:.2%}, estimate {row.estimate:.4f}"
        for row in rows
        if row.is_linear and min(row.default, row.finer) < ENOUGH
    ]
    return "\n".join([f"Linear, and the same on less than {ENOUGH:.1%} of the area:\n", *lines]) + "\n"


if __name__ == "__main__":
    raise SystemExit(main())
