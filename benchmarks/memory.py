"""Memory that each stage takes at most, beside what was said before it began; each measured in a process of its own.

usage: python -m benchmarks.memory [--stages NAME ...] [--vertices N ...]

Shapes are the example humanoid, and a ball with arms: matrices of closed round shapes fill most when they are factored.
"""

import argparse
import ctypes
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from benchmarks.size import _body
from compute import (
    Analysis,
    TriangleMesh,
    analyze,
    binding_weights,
    correspond,
    match,
    register,
    skeleton,
    solve_eigenbasis,
)
from tests.shapes import star

SIZES = (13_000, 50_000)
Work = Callable[[], object]


def _mesh(shape: str, n_vertices: int) -> TriangleMesh:
    if shape == "body":
        return _body(n_vertices)
    return star(n_subdivisions=next(k for k in range(4, 9) if 10 * 4**k + 2 >= n_vertices / 2))


def _two(mesh: TriangleMesh, order: int | str = "auto") -> tuple[Analysis, Analysis]:
    """Return a mesh and the same under other numbers, bent a little, so that nothing corresponds by number."""
    vertices = mesh.vertices + 0.02 * mesh.vertices[:, [1, 2, 0]] ** 2
    other = TriangleMesh(vertices[::-1], len(vertices) - 1 - mesh.triangles[: len(mesh.triangles) - 4])
    return analyze(mesh, order=order), analyze(other, order=order)


def _analyze(mesh: TriangleMesh, order: int | str, n_functions: int | None = None) -> Work:
    return lambda: analyze(mesh, order=order, n_functions=n_functions)


def _of_analysis(work: Callable[[Analysis], object], order: int | str = "auto") -> Callable[[TriangleMesh], Work]:
    def prepared(mesh: TriangleMesh) -> Work:
        analysis = analyze(mesh, order=order)
        return lambda: work(analysis)

    return prepared


def _of_skeleton(mesh: TriangleMesh) -> Work:
    analysis = analyze(mesh)
    bones = skeleton(analysis)
    return lambda: binding_weights(analysis, bones)


def _of_pair(work: Callable[[Analysis, Analysis], object]) -> Callable[[TriangleMesh], Work]:
    def prepared(mesh: TriangleMesh) -> Work:
        source, target = _two(mesh)
        return lambda: work(source, target)

    return prepared


STAGES: dict[str, Callable[[TriangleMesh], Work]] = {
    **{f"analyze, order {order}": lambda mesh, order=order: _analyze(mesh, order) for order in (1, 2, 3, "auto")},
    **{
        f"solve_eigenbasis, order {order}, 100 functions": lambda mesh, order=order: (
            lambda: solve_eigenbasis(mesh, 100, order=order)
        )
        for order in (1, 2, 3)
    },
    "segment, order 1": _of_analysis(lambda analysis: analysis.segment(), order=1),
    "skeleton, order 1": _of_analysis(skeleton, order=1),
    "segment": _of_analysis(lambda analysis: analysis.segment()),
    "borders": _of_analysis(lambda analysis: analysis.segment().borders),
    "skeleton": _of_analysis(skeleton),
    "binding_weights": _of_skeleton,
    "match": _of_pair(match),
    "correspond": _of_pair(correspond),
    "register": _of_pair(lambda source, target: register([source, target])),
}


def main(arguments: list[str] | None = None) -> int:
    """Print one row of a Markdown table for each stage, shape and size."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--stages", nargs="+", default=sorted(STAGES), choices=sorted(STAGES))
    parser.add_argument("--vertices", type=int, nargs="+", default=SIZES)
    parser.add_argument("--shapes", nargs="+", default=("body", "star"))
    parser.add_argument("--one", nargs=3, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.one:
        shape, size, stage = options.one
        sys.stdout.write(json.dumps(_measure(_mesh(shape, int(size)), stage)))
        return 0
    sys.stdout.write(
        "| stage | shape | vertices | MB taken | MB said before | said / taken |\n|---|---|---|---|---|---|\n"
    )
    for stage in options.stages:
        for shape in options.shapes:
            for size in options.vertices:
                sys.stdout.write(_row(stage, shape, size))
                sys.stdout.flush()
    return 0


def _row(stage: str, shape: str, size: int) -> str:
    command = [sys.executable, "-m", "benchmarks.memory", "--one", shape, str(size), stage]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        return f"| {stage} | {shape} | {size} | {run.stderr.strip().splitlines()[-1]} | | |\n"
    n_vertices, taken, said = json.loads(run.stdout)
    return f"| {stage} | {shape} | {n_vertices} | {taken / 1e6:.0f} | {said / 1e6:.0f} | {said / taken:.2f} |\n"


def _measure(mesh: TriangleMesh, stage: str) -> tuple[int, float, float]:
    """Return vertices, the bytes that a stage took beyond what was there before, and those said before it began."""
    # The libraries that it loads are there already.
    STAGES[stage](star(n_subdivisions=3))()
    work = STAGES[stage](mesh)
    said = _record_needs()
    ctypes.CDLL(None).malloc_trim(0)
    Path("/proc/self/clear_refs").write_text("5")
    before = _status("VmRSS")
    work()
    return len(mesh.vertices), _status("VmHWM") - before, max(said, default=0.0)


def _status(name: str) -> float:
    """Return a number of bytes from what Linux knows of this process."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return 1024.0 * next(int(line.split()[1]) for line in lines if line.startswith(name + ":"))


def _record_needs() -> list[float]:
    """Return a list that gets the bytes of every estimate that is checked from now on."""
    needs: list[float] = []
    for module in list(sys.modules.values()):
        if module.__name__.startswith("compute.") and hasattr(module, "require_memory"):
            module.require_memory = lambda needed, *_: needs.append(needed)
    return needs


if __name__ == "__main__":
    sys.exit(main())
