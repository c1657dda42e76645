"""The plots of docs/spectrum.md, from rows of `benchmarks.spectrum` or from the tables that stand on the page."""

from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

STYLES = {
    "cubic": ("tab:red", "o"),
    "quadratic": ("tab:orange", "s"),
    "linear": ("tab:purple", "^"),
    "scipy": ("tab:gray", "x"),
    "cholespy": ("tab:green", "d"),
    "lapy": ("tab:blue", "v"),
}
NAMES = {
    "cubic": "cubic, ours",
    "quadratic": "quadratic, ours",
    "linear": "linear, ours",
    "scipy": "cubic, scipy's plain eigsh",
    "cholespy": "cubic, eigsh with cholespy",
    "lapy": "linear, LaPy",
}


PAGE = Path(__file__).parents[1] / "docs" / "spectrum.md"


def draw(results: dict[str, list[dict]], folder: Path) -> None:
    """Draw the plots of all tables there are."""
    folder.mkdir(parents=True, exist_ok=True)
    plots = {"convergence": _convergence, "accuracy": _accuracy, "size": _size}
    for name, rows in results.items():
        _save(plots[name], rows, folder / f"spectrum_{name}.png")


def draw_convergence(target: Path) -> None:
    """Measure how eigenvalues of the tetrahedron converge, which takes seconds, and plot it."""
    from benchmarks.spectrum import convergence_rows

    _save(_convergence, convergence_rows(), target)


def draw_accuracy(target: Path) -> None:
    """Plot the table of accuracy on the page, so that plot and table agree."""
    _save(_accuracy, rows_on_page({"solver", "vertices", "error", "CPU s"}), target)


def draw_size(target: Path) -> None:
    """Plot the table of costs on the page."""
    _save(_size, rows_on_page({"mesh", "vertices", "pairs", "solver", "CPU s", "λ to ours"}), target)


def rows_on_page(columns: set[str]) -> list[dict]:
    """Return the rows of the first table of the page that has some columns; numbers as numbers."""
    lines = PAGE.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if columns <= set(_cells(line)))
    header, rows = _cells(lines[start]), []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        rows.append({name: _value(cell) for name, cell in zip(header, _cells(line), strict=True)})
    return rows


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


def _value(cell: str) -> float | str:
    try:
        return float(cell)
    except ValueError:
        return cell


def _save(plot: Callable[[plt.Axes, list[dict]], None], rows: list[dict], target: Path) -> None:
    figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    plot(axes, rows)
    axes.set(xscale="log", yscale="log")
    axes.grid(alpha=0.3)
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.10g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(fontsize=8)
    figure.savefig(target, dpi=110)
    plt.close(figure)


def _convergence(axes: plt.Axes, rows: list[dict]) -> None:
    for order, solver in ((1, "linear"), (2, "quadratic"), (3, "cubic")):
        edges, errors = np.array([(r["edges"], r["error"]) for r in rows if r["order"] == order]).T
        slope = -np.polyfit(np.log(edges[-3:]), np.log(errors[-3:]), 1)[0]
        color, marker = STYLES[solver]
        axes.plot(edges, errors, marker=marker, color=color, label=f"order {order}: error ~ $h^{{{slope:.2f}}}$")
    axes.set(xlabel="edges along a side of the tetrahedron, 1/h", ylabel="relative error of the first eigenvalue")


def _accuracy(axes: plt.Axes, rows: list[dict]) -> None:
    for solver, (color, marker) in STYLES.items():
        points = sorted((r["CPU s"], r["error"], r["vertices"]) for r in rows if r["solver"] == solver)
        if points:
            seconds, errors, sizes = np.array(points).T
            axes.plot(seconds, errors, marker=marker, color=color, label=NAMES[solver])
            for x, y, n in zip(seconds, errors, sizes, strict=True):
                axes.annotate(f"{n / 1000:.0f}k", (x, y), textcoords="offset points", xytext=(5, 5), fontsize=7)
    axes.set(xlabel="CPU seconds", ylabel="largest relative error of ten eigenvalues")


def _size(axes: plt.Axes, rows: list[dict]) -> None:
    for solver, (color, marker) in STYLES.items():
        points = sorted(
            (r["vertices"], r["CPU s"])
            for r in rows
            if r["solver"] == solver and r["pairs"] == 10 and r["mesh"] == "bumpy sphere"
        )
        if points:
            axes.plot(*np.array(points).T, marker=marker, color=color, label=NAMES[solver])
    axes.set(xlabel="vertices of the mesh", ylabel="CPU seconds for 10 pairs")
