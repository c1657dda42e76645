"""What commands have in common that work on each mesh of a file."""

import argparse
from collections.abc import Callable
from typing import Any

import bpy

from ..compute.errors import EngineError
from ..compute.segmentation.parts.part_labels import BranchLabels
from ..operators.mesh_state import state
from ..operators.messages.user_errors import Refusal
from ..operators.parts.analysis_request import analysis_options
from ..operators.parts.analyze import Outcome
from .report import Report, part_rows


def chosen(objects: list[bpy.types.Object], name: str | None) -> list[bpy.types.Object]:
    """Return the object of that name, or the one that stands for its mesh; all if there is no name."""
    named = {obj.data for obj in bpy.data.objects if obj.name == name}
    found = [obj for obj in objects if name is None or obj.data in named]
    if not found:
        raise Refusal(f"there is no mesh object {name!r}; there are {', '.join(obj.name for obj in objects)}.")
    return found


def report_each(objects: list[bpy.types.Object], work: Callable[[bpy.types.Object], Report]) -> list[Report]:
    """Return a row for each object; what is wrong with one does not stop the others of its file."""
    return [_report(obj, work) for obj in objects]


def analysis_settings(options: argparse.Namespace) -> dict[str, Any]:
    """Return the settings of the analysis for the options that were given."""
    field = options.field
    kind = "DIFFUSION" if field == "diffusion" else "EIGENFUNCTION" if field.isdecimal() else "ATTRIBUTE"
    number = int(field) if kind == "EIGENFUNCTION" else 1
    attribute = field if kind == "ATTRIBUTE" else ""
    field_settings = {"field": kind, "eigenfunction": number, "attribute": attribute}
    return {**field_settings, "order": "AUTO", "boundary": "NEUMANN", "shells": options.shells.upper()}


def engine_options(mesh: bpy.types.Mesh, options: argparse.Namespace) -> dict[str, Any]:
    """Return the keyword arguments of the engine for the options that were given."""
    return analysis_options(mesh, **analysis_settings(options))


def store(mesh: bpy.types.Mesh, outcome: Outcome) -> tuple[str, ...]:
    """Put an analysis on its mesh, and return warnings."""
    return state.store(mesh, outcome.stored, outcome.source, outcome.description)


def row_of(obj: bpy.types.Object, labels: BranchLabels, outcome: Outcome, warnings: tuple[str, ...]) -> Report:
    """Return what the report says of a divided object."""
    return {
        "name": obj.name,
        "level": labels.level,
        "n_levels": outcome.stored.part_tree.hierarchy.n_levels,
        "parts": part_rows(obj.data, labels),
        "seconds": round(outcome.seconds, 3),
        "warnings": [*outcome.warnings, *warnings, *labels.warnings],
    }


def _report(obj: bpy.types.Object, work: Callable[[bpy.types.Object], Report]) -> Report:
    try:
        return work(obj)
    except (Refusal, EngineError) as refusal:
        return {"name": obj.name, "error": str(refusal)}
