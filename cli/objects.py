"""The meshes of a file that a command works on, and the rows of the report about them."""

import argparse
from collections.abc import Callable
from dataclasses import replace

import bpy

from .. import compute
from ..compute.errors import EngineError
from ..operators.blender.known_values import mesh_of
from ..operators.mesh_data.world_shape import size_of
from ..operators.messages.sentences import Messages
from ..operators.parts.analysis_settings import AnalysisSettings
from ..operators.parts.choice_items import ATTRIBUTE, EIGENFUNCTION, identifier
from ..tasks.mesh_analysis import AnalysisResult
from ..tasks.refusals import Refusal
from .formats import OpenFile
from .reports.report import ObjectRow, part_rows


def chosen_objects(file: OpenFile, name: str | None) -> OpenFile:
    """Return a file with the object of that name, or the one that stands for its mesh; all if there is no name."""
    named = {obj.data for obj in bpy.data.objects if obj.name == name}
    chosen = [obj for obj in file.objects if name is None or obj.data in named]
    if not chosen:
        raise Refusal(f"there is no mesh object {name!r}; there are {', '.join(obj.name for obj in file.objects)}.")
    return replace(file, objects=chosen)


def report_each(file: OpenFile, work: Callable[[bpy.types.Object], ObjectRow]) -> tuple[OpenFile, list[ObjectRow]]:
    """Return a file with a row for each object; what is wrong with one does not stop the others of its file."""
    return file, [_report(obj, work, file.repairs_of(obj)) for obj in file.objects]


def analysis_settings(options: argparse.Namespace) -> AnalysisSettings:
    """Return the settings of the analysis for the options that were given."""
    settings = AnalysisSettings(shells=identifier(options.shells), borders=identifier(options.borders))
    if options.field in compute.FIELDS:
        return replace(settings, field=identifier(options.field))
    if options.field.isdecimal():
        return replace(settings, field=EIGENFUNCTION, eigenfunction=int(options.field))
    return replace(settings, field=ATTRIBUTE, attribute=options.field)


def row_of(
    obj: bpy.types.Object,
    labels: "compute.BranchLabels | compute.FaceLabels",
    result: AnalysisResult,
    messages: Messages,
) -> ObjectRow:
    """Return the row of a divided object in the report; areas are those in the world."""
    parts = part_rows(mesh_of(obj), labels)
    for part in parts:
        part["area"] *= size_of(obj) ** 2
    row: ObjectRow = {
        "name": obj.name,
        "level": labels.level,
        "n_levels": result.stored.part_tree.hierarchy.n_levels,
        "parts": parts,
        "seconds": round(result.seconds, 3),
        "warnings": list(messages.warnings),
    }
    if result.elements is not None:
        row["elements"] = result.elements.lower()
    return row


def _report(obj: bpy.types.Object, work: Callable[[bpy.types.Object], ObjectRow], repairs: list[str]) -> ObjectRow:
    try:
        row = work(obj)
    except (Refusal, EngineError) as refusal:
        return {"name": obj.name, "error": str(refusal)}
    row["warnings"] = [*repairs, *row["warnings"]]
    return row
