"""How fast, how large and how accurate the eigenfunctions are, with other solvers in the same run.

``python -m benchmarks.spectrum [--data DIR] [--output DIR]`` writes Markdown tables to standard output and, with
``--output``, the plots of docs/spectrum.md. Every solver runs in a process of its own with one BLAS thread; CPU seconds
are the least of some runs, peak memory is what the process grew by.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.spectrum_solvers import SOLVERS, bumpy_sphere, read_obj, subdivide, tetrahedron, versions
from compute.surface.mesh import TriangleMesh

BODY = "makehuman/mh_body_0_rest.obj"

# Factoring with scipy's default ordering takes minutes beyond this size.
MOST_VERTICES_OF_PLAIN_SCIPY = 20_000

# A run that takes longer is given up, in seconds.
TIME_LIMIT = 400


def main(arguments: list[str] | None = None) -> None:
    """Run the tables that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, help="folder with the makehuman body")
    parser.add_argument("--output", type=Path, help="folder for the plots")
    parser.add_argument("--tables", nargs="+", default=["convergence", "accuracy", "size"])
    parser.add_argument("--sizes", nargs="+", type=int, default=[5_000, 10_000, 20_000, 40_000, 80_000, 160_000])
    parser.add_argument("--pairs", nargs="+", type=int, default=[10, 30])
    parser.add_argument("--solvers", nargs="+", default=list(SOLVERS), choices=list(SOLVERS))
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args(arguments)
    print(versions())
    tables = {"convergence": convergence, "accuracy": accuracy, "size": sizes}
    results = {name: tables[name](options) for name in options.tables}
    if options.output:
        from benchmarks.spectrum_plots import draw

        draw(results, options.output)


def convergence(options: argparse.Namespace) -> list[dict]:
    """Tabulate the error of the first eigenvalue of the regular tetrahedron, where flat triangles are exact."""
    rows = convergence_rows()
    print_table("Convergence on the regular tetrahedron", rows)
    return rows


def convergence_rows() -> list[dict]:
    """Return the largest relative error of the first eigenvalue for each order and fineness."""
    exact = 4 * np.pi**2 / 3
    rows = []
    for order in (1, 2, 3):
        for n in range(2, 6):
            found = measured(("linear", "quadratic", "cubic")[order - 1], tetrahedron(n), 3, repeats=1)
            rows.append({"order": order, "edges": 2**n, "error": max(abs(np.array(found["values"]) / exact - 1))})
    return rows


def accuracy(options: argparse.Namespace) -> list[dict]:
    """Tabulate errors of ten eigenvalues on one polyhedron against CPU seconds; finer meshes are subdivided flat."""
    name, mesh = _character(options) or ("bumpy sphere", bumpy_sphere(5_000))
    finer = subdivide(mesh)
    reference = np.array(measured("cubic", finer, 10, repeats=1)["values"])
    runs = [(solver, mesh) for solver in ("linear", "quadratic", "cubic", "lapy")]
    runs += [("lapy", finer), ("lapy", subdivide(finer)), ("linear", finer), ("quadratic", finer)]
    rows = []
    for solver, surface in runs:
        found = measured(solver, surface, 10, options.repeats)
        if found:
            error = float(np.abs(np.array(found["values"]) / reference - 1).max())
            rows.append({"solver": solver, "vertices": len(surface.vertices), "error": error, **_costs(found)})
    print_table(f"Largest relative error of ten eigenvalues, {name}, against cubic elements on the finer mesh", rows)
    return rows


def sizes(options: argparse.Namespace) -> list[dict]:
    """Tabulate time and memory against the number of vertices, and how far the values are from plain scipy's."""
    meshes = [("bumpy sphere", bumpy_sphere(size)) for size in options.sizes]
    character = _character(options)
    if character:
        meshes += [character, (f"{character[0]}, subdivided", subdivide(character[1]))]
    rows = []
    for name, mesh in meshes:
        for n_pairs in options.pairs:
            rows += _compared(name, mesh, n_pairs, options)
    print_table("Time and memory", rows)
    return rows


def _compared(name: str, mesh: TriangleMesh, n_pairs: int, options: argparse.Namespace) -> list[dict]:
    rows = []
    n_vertices = len(mesh.vertices)
    is_slow = n_vertices > MOST_VERTICES_OF_PLAIN_SCIPY or n_pairs != 10
    solvers = [solver for solver in options.solvers if not (is_slow and solver == "scipy")]
    ours: np.ndarray | None = None
    for solver in solvers:
        found = measured(solver, mesh, n_pairs, 1 if solver == "scipy" else options.repeats)
        if not found:
            continue
        ours = np.array(found["values"]) if solver == "cubic" else ours
        row = {"mesh": name, "vertices": n_vertices, "pairs": n_pairs, "solver": solver, **_costs(found)}
        row["kB/vertex"] = found["peak"] / n_vertices
        row["λ to ours"] = float(np.abs(np.array(found["values"]) / ours - 1).max()) if ours is not None else 0.0
        rows.append(row)
        print("  ", row, file=sys.stderr, flush=True)
    return rows


def _costs(found: dict) -> dict:
    return {"CPU s": found["cpu"], "wall s": found["wall"]}


def _character(options: argparse.Namespace) -> tuple[str, TriangleMesh] | None:
    path = options.data / BODY if options.data else None
    if path is None or not path.exists():
        print("The makehuman body is left out: no --data folder holds it.")
        return None
    return "makehuman body", read_obj(path)


def measured(solver: str, mesh: TriangleMesh, n_pairs: int, repeats: int) -> dict | None:
    """Return values, CPU and wall seconds and peak memory in kB of the best of some runs; None if none ended."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.npz"
        np.savez(path, vertices=mesh.vertices, triangles=mesh.triangles)
        command = [sys.executable, "-m", "benchmarks.spectrum_solvers", solver, str(path), str(n_pairs)]
        environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        runs = []
        for _ in range(repeats):
            try:
                done = subprocess.run(command, env=environment, timeout=TIME_LIMIT, capture_output=True, check=True)
            except (subprocess.TimeoutExpired, subprocess.CalledProcessError) as error:
                print(f"   {solver} with {len(mesh.vertices)} vertices: {type(error).__name__}", file=sys.stderr)
                return None
            runs.append(json.loads(done.stdout))
    return min(runs, key=lambda run: run["cpu"])


def print_table(title: str, rows: list[dict]) -> None:
    """Print rows as a Markdown table."""
    columns = list(rows[0])
    lines = [f"\n### {title}\n", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(_cell(row[column]) for column in columns) + " |" for row in rows]
    print("\n".join(lines), flush=True)


def _cell(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    main()
