"""The command ``segment``: each mesh divided into parts of its own."""

import argparse
from pathlib import Path
from typing import cast

import bpy

from ..compute.progress import silent
from ..operators.blender.known_values import mesh_of
from ..operators.parts import mesh_segmentation
from ..tasks import mesh_analysis
from ..tasks.level_choice import LevelChoice
from . import formats
from .formats import OpenFile
from .objects import analysis_settings, chosen_objects, report_each, row_of
from .reports.report import ObjectRow, Settings


class Segment:
    """Divides files with the options of one call."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options

    @property
    def settings(self) -> Settings:
        """All that the results depend on besides the files."""
        options = self._options
        given = {name: getattr(options, name) for name in ("object", "field", "shells", "borders", "mode")}
        return {"command": "segment", **given, "choice": choice_of(options)}

    def open_and_process(self, path: Path) -> tuple[OpenFile, list[ObjectRow]]:
        """Leave a file open with its meshes divided, and return it with a row for each."""
        return report_each(chosen_objects(formats.load(path), self._options.object), self._divide)

    def _divide(self, obj: bpy.types.Object) -> ObjectRow:
        given = mesh_segmentation.read(bpy.context, obj, analysis_settings(self._options))
        result = mesh_analysis.analyze(given, silent)
        segmented = mesh_segmentation.write(
            mesh_of(obj), result, mode=self._options.mode, choice=choice_of(self._options)
        )
        return row_of(obj, segmented.labels, result, segmented.messages)


def choice_of(options: argparse.Namespace) -> LevelChoice:
    """Return the level, threshold or number of parts that was given, if any."""
    choice = {name: getattr(options, name) for name in LevelChoice.__annotations__}
    return cast(LevelChoice, {name: value for name, value in choice.items() if value is not None})
