"""The command ``segment``: every mesh of every file divided into parts; one bad file does not stop the rest."""

import argparse
import json
import time
from pathlib import Path
from typing import Any, TextIO

import bpy

from ..compute.errors import EngineError
from ..compute.progress import silent
from ..compute.segmentation.parts import BranchLabels
from ..operators import exchange, results, state
from ..operators.analysis_request import analysis_options
from ..operators.analyze import analyze_arrays
from ..operators.refusals import Refusal
from . import formats
from .names import name_of_part
from .quiet import blender_is_quiet

# Raised when the layout of the report changes.
REPORT_VERSION = 1


def run(options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    """Divide all files, tell about each, and return 1 if any failed."""
    reports = []
    for path in options.files:
        reports.append(_report_file(path, options))
        if error := reports[-1].get("error"):
            err.write(f"{path}: {error}\n")
        elif not options.json:
            out.write(_sentence(reports[-1]) + "\n")
    if options.json:
        out.write(json.dumps({"version": REPORT_VERSION, "files": reports}, indent=2) + "\n")
    return int(any("error" in report for report in reports))


def _report_file(path: Path, options: argparse.Namespace) -> dict[str, Any]:
    start = time.perf_counter()
    report: dict[str, Any] = {"file": str(path)}
    try:
        with blender_is_quiet():
            report |= _divide_file(path, options)
    except (Refusal, EngineError) as refusal:
        report["error"] = str(refusal)
    except Exception as error:
        # One broken file must not take the batch down, whatever Blender or the file does.
        report["error"] = " ".join(f"{type(error).__name__}: {error}".split())
    return report | {"seconds": round(time.perf_counter() - start, 3)}


def _divide_file(path: Path, options: argparse.Namespace) -> dict[str, Any]:
    rows = [_report_object(obj, options) for obj in _chosen(formats.load(path), options.object)]
    report: dict[str, Any] = {"objects": rows}
    if problems := [f"{row['name']}: {row['error']}" for row in rows if "error" in row]:
        report["error"] = " ".join(problems)
    if len(problems) < len(rows):
        report["output"] = str(formats.save(path, options.output or path.parent))
    return report


def _chosen(objects: list[bpy.types.Object], name: str | None) -> list[bpy.types.Object]:
    chosen = [obj for obj in objects if name in (None, obj.name)]
    if not chosen:
        raise Refusal(f"there is no mesh object {name!r}; there are {', '.join(obj.name for obj in objects)}.")
    return chosen


def _report_object(obj: bpy.types.Object, options: argparse.Namespace) -> dict[str, Any]:
    """Divide one object; what is wrong with it does not stop the others of its file."""
    try:
        return _divide_object(obj, options)
    except (Refusal, EngineError) as refusal:
        return {"name": obj.name, "error": str(refusal)}


def _divide_object(obj: bpy.types.Object, options: argparse.Namespace) -> dict[str, Any]:
    mesh = obj.data
    results.refuse_foreign_results(mesh)
    outcome = analyze_arrays(exchange.read_mesh(mesh), _engine_options(mesh, options.field), silent)
    state.store(mesh, outcome.stored, outcome.source, outcome.description)
    choice = {name: getattr(options, name) for name in ("level", "threshold", "n_parts")}
    given = {name: value for name, value in choice.items() if value is not None}
    labels = results.segment_mesh(mesh, mode=options.mode, **given)
    return {
        "name": obj.name,
        "level": labels.level,
        "n_levels": outcome.stored.hierarchy.n_levels,
        "parts": part_rows(labels),
        "seconds": round(outcome.seconds, 3),
        "warnings": [*outcome.warnings, *labels.warnings],
    }


def _engine_options(mesh: bpy.types.Mesh, field: str) -> dict[str, Any]:
    kind = "DIFFUSION" if field == "diffusion" else "EIGENFUNCTION" if field.isdigit() else "ATTRIBUTE"
    number = int(field) if kind == "EIGENFUNCTION" else 0
    return analysis_options(mesh, kind, number, field, order="AUTO", boundary="NEUMANN")


def part_rows(labels: BranchLabels) -> list[dict[str, Any]]:
    """Return the table of parts as it stands in reports."""
    parts = labels.parts
    columns = (parts.id.tolist(), parts.parent.tolist(), parts.area.tolist(), parts.n_triangles.tolist())
    return [
        {"id": part, "name": name_of_part(part), "parent": parent, "area": area, "faces": n_faces}
        for part, parent, area, n_faces in zip(*columns, strict=True)
    ]


def _sentence(report: dict[str, Any]) -> str:
    counts = ", ".join(f"{row['name']}: {len(row['parts'])} parts" for row in report["objects"])
    return f"{report['file']}: {counts}, {report['seconds']:.1f} s, written to {report['output']}"
