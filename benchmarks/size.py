"""What big meshes take: time and memory of ``analyze`` and one division, each size in a process of its own.

usage: python -m benchmarks.size [--vertices N ...] [--order auto|1|2|3]
"""

import argparse
import json
import resource
import subprocess
import sys
import time
from itertools import pairwise
from typing import Any

from benchmarks.spectrum_solvers import subdivide
from compute import TriangleMesh, analyze
from compute.fem.order_choice import memory_of_functions
from examples import humanoid

SIZES = (13_000, 50_000, 200_000, 500_000)
# Meshes larger than this are made from smaller ones whose faces are split.
LARGEST_MADE = 60_000


def main(arguments: list[str] | None = None) -> int:
    """Print one row of a Markdown table for each size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vertices", type=int, nargs="+", default=SIZES)
    parser.add_argument("--order", default="auto")
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.one:
        sys.stdout.write(json.dumps(_measure(_body(options.one), options.order)))
        return 0
    headings = (
        "vertices",
        "elements",
        "CPU s",
        "wall s",
        "GB",
        "kB a vertex",
        "GB said before",
        "parts",
        "longest stages, CPU s",
    )
    sys.stdout.write(f"| {' | '.join(headings)} |\n{'|---' * len(headings)}|\n")
    for size in options.vertices:
        command = [sys.executable, "-m", "benchmarks.size", "--one", str(size), "--order", options.order]
        row = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        sys.stdout.write(f"| {' | '.join(str(value) for value in row)} |\n")
        sys.stdout.flush()
    return 0


def _body(n_vertices: int) -> TriangleMesh:
    n_splits = 0
    while n_vertices / 4**n_splits > LARGEST_MADE:
        n_splits += 1
    character = humanoid(n_vertices // 4**n_splits)
    mesh = TriangleMesh(character.vertices, character.triangles)
    for _ in range(n_splits):
        mesh = subdivide(mesh)
    return mesh


def _measure(mesh: TriangleMesh, order: str) -> list[Any]:
    stages = [(time.process_time(), "")]
    before, wall = _peak(), time.perf_counter()
    analysis = analyze(
        mesh,
        order=order if order == "auto" else int(order),
        progress=lambda fraction, text: stages.append((time.process_time(), text)),
    )
    n_parts = analysis.segment(mode="nested").n_parts
    stages.append((time.process_time(), ""))
    size, peak = len(mesh.vertices), _peak() - before
    return [
        size,
        ("linear", "quadratic", "cubic")[analysis.eigenbasis.order - 1],
        f"{stages[-1][0] - stages[0][0]:.1f}",
        f"{time.perf_counter() - wall:.1f}",
        f"{peak / 1e9:.2f}",
        f"{peak / 1e3 / size:.1f}",
        f"{memory_of_functions(len(analysis.eigenbasis.nodes)) / 1e9:.2f}",
        n_parts,
        _longest(stages),
    ]


def _peak() -> float:
    """Return the bytes of memory this process had at most."""
    return 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _longest(stages: list[tuple[float, str]]) -> str:
    seconds: dict[str, float] = {}
    for (start, text), (stop, _) in pairwise(stages):
        seconds[text] = seconds.get(text, 0) + stop - start
    first = sorted(seconds, key=seconds.__getitem__, reverse=True)[:3]
    return ", ".join(f"{text or 'start and division'} {seconds[text]:.1f}" for text in first)


if __name__ == "__main__":
    sys.exit(main())
