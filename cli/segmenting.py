"""The command ``segment``: each mesh divided into parts of its own."""

import argparse
from pathlib import Path
from typing import Any

import bpy

from ..compute.progress import silent
from ..operators.mesh_data import mesh_arrays
from ..operators.mesh_state.state import read
from ..operators.outputs import part_writer
from ..operators.parts.analyze import analyze_arrays
from . import formats
from .objects import chosen, engine_options, report_each, row_of, store
from .report import Report


class Segment:
    """Divides files with the options of one call."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options

    @property
    def settings(self) -> Report:
        """What the results depend on besides the files."""
        options = self._options
        given = {"object": options.object, "field": options.field, "shells": options.shells, "mode": options.mode}
        return {"command": "segment", **given, "choice": choice_of(options)}

    def open_and_divide(self, path: Path) -> list[Report]:
        """Leave a file open with its meshes divided, and return a row for each."""
        return report_each(chosen(formats.load(path), self._options.object), self._divide)

    def _divide(self, obj: bpy.types.Object) -> Report:
        mesh = obj.data
        part_writer.refuse_foreign_results(read(mesh))
        outcome = analyze_arrays(mesh_arrays.read_mesh(mesh), engine_options(mesh, self._options), silent)
        warnings = store(mesh, outcome)
        labels = part_writer.segment_mesh(mesh, mode=self._options.mode, **choice_of(self._options))
        return row_of(obj, labels, outcome, warnings)


def choice_of(options: argparse.Namespace) -> dict[str, Any]:
    """Return the level, threshold or number of parts that was given, if any."""
    choice = {name: getattr(options, name) for name in ("level", "threshold", "n_parts")}
    return {name: value for name, value in choice.items() if value is not None}
