"""The command ``transfer``: weights, shape keys, UV maps, colours and attributes of a source on each mesh."""

import argparse
import time
from dataclasses import replace
from functools import cached_property
from pathlib import Path

import bpy

from ..compute.errors import EngineError
from ..compute.progress import silent
from ..operators.messages.sentences import Messages
from ..operators.transfer import mesh_transfer
from ..operators.transfer.layer_reading import LayerChoice
from ..operators.transfer.mesh_transfer import TransferSettings, TransferSource
from ..tasks.layer_mapping import MappedLayers, map_to_all
from ..tasks.refusals import Refusal
from . import formats
from .formats import OpenFile
from .formats.points import points_of, settings_of_points
from .objects import chosen_objects, report_each
from .reports.report import ObjectRow, Settings
from .results.digests import digest_of


class Transfer:
    """Transfers to files with the options of one call; the source is read when it is first needed."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        # What was mended when the source was read.
        self._repairs: list[str] = []

    @cached_property
    def settings(self) -> Settings:
        """All that the results depend on besides the files."""
        options = self._options
        if not options.source.is_file():
            raise Refusal(f"the source {options.source}: there is no such file.")
        source = {"file": options.source.name, "digest": digest_of(options.source), "object": options.reference}
        chosen = {name: getattr(options, name) for name in ("object", "layers", "mirrored", "method")}
        return {"command": "transfer", **chosen, **settings_of_points(options.points), "source": source}

    def open_and_process(self, path: Path) -> tuple[OpenFile, list[ObjectRow]]:
        """Leave a file open whose meshes have the layers of the source, and return it with a row for each."""
        # The source opens a file of its own, so it comes first.
        source = self._source
        file = chosen_objects(formats.load(path), self._options.object)
        if path.resolve() == self._options.source.resolve():
            file = replace(file, objects=[obj for obj in file.objects if obj.name != source.name])
        if not file.objects:
            raise Refusal("there is no mesh in this file but the source.")
        return report_each(file, self._transfer)

    @cached_property
    def _source(self) -> TransferSource:
        try:
            file = chosen_objects(formats.load(self._options.source), self._options.reference)
            obj = file.objects[0]
            self._repairs = [f"{obj.name}: {repair}" for repair in file.repairs_of(obj)]
            return mesh_transfer.read_source(bpy.context, obj, self._settings)
        except (Refusal, EngineError) as error:
            raise Refusal(f"the source {self._options.source}: {error}") from error

    @property
    def _settings(self) -> TransferSettings:
        kinds = frozenset(kind.upper() for kind in self._options.layers)
        choice = LayerChoice(kinds, "ALL", (), self._options.mirrored)
        return TransferSettings(choice, method=self._options.method)

    def _transfer(self, obj: bpy.types.Object) -> ObjectRow:
        start = time.perf_counter()
        source, settings = self._source, self._settings
        points = points_of(self._options.points)
        target = mesh_transfer.read_target(bpy.context, obj, source, settings, points)
        mapped = map_to_all(
            source.shape, source.layers, [target], silent, fills=settings.fills_unsure, method=settings.method
        )
        (messages,) = mesh_transfer.write_all([obj], mapped, source, settings)
        row = _row(obj, source, mapped[0], messages)
        row["warnings"] += self._repairs
        return row | {"seconds": round(time.perf_counter() - start, 3)}


def _row(obj: bpy.types.Object, source: TransferSource, mapped: MappedLayers, messages: Messages) -> ObjectRow:
    return {
        "name": obj.name,
        "source": source.name,
        "confidence": round(mapped.confidence, 4),
        "found_by": mapped.found_by,
        "layers": [layer.name for layer in mapped.layers],
        "unsure_vertices": int((~mapped.is_sure).sum()),
        "unsure_parts": {part: round(share, 4) for part, share in mapped.unsure_parts.items()},
        "warnings": list(messages.warnings),
    }
