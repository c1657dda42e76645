"""The command ``register``: each mesh divided into the parts of a reference."""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import bpy
import numpy as np

from .. import compute
from ..compute.errors import EngineError
from ..operators.mesh_data import mesh_arrays
from ..operators.mesh_state import registration_record, state
from ..operators.messages.user_errors import Refusal
from ..operators.outputs import part_writer
from ..operators.parts.analyze import Outcome, outcome_of
from ..operators.registration.register_meshes import Found, Wish, register_analyzed
from ..operators.registration.registering import match_of
from . import formats
from .objects import analysis_settings, chosen, engine_options, report_each, row_of, store
from .report import Report
from .resume import digest_of
from .segmenting import choice_of


@dataclass(frozen=True, eq=False)
class Reference:
    """The object whose parts all others get.

    Attributes
    ----------
    name : str
        Of the object.
    outcome : Outcome
        Of its analysis.
    level : int
    mode : str
        What it shows.
    prepared : compute.Reference
        What others are matched with.
    tables : dict
        Names and colours of its parts.
    """

    name: str
    outcome: Outcome
    level: int
    mode: str
    prepared: compute.Reference
    tables: dict[str, Any]

    @property
    def highest_label(self) -> int:
        """The last of the labels that all share."""
        return self.prepared.parts.given.highest


class Register:
    """Registers files with the options of one call; the reference is prepared when it is first needed."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._wish = Wish(mirrored=options.mirrored)
        self._first_free = 0

    @cached_property
    def settings(self) -> Report:
        """What the results depend on besides the files."""
        options = self._options
        if not options.source.is_file():
            raise Refusal(f"the reference {options.source}: there is no such file.")
        source = {"file": options.source.name, "digest": digest_of(options.source), "object": options.reference}
        given = {"object": options.object, "field": options.field, "shells": options.shells, "mode": options.mode}
        chosen_parts = {"choice": choice_of(options), "mirrored": options.mirrored}
        return {"command": "register", **given, **chosen_parts, "source": source}

    def open_and_divide(self, path: Path) -> list[Report]:
        """Leave a file open with its meshes divided, and return a row for each."""
        # The reference opens a file of its own, so it comes first.
        reference = self._reference
        objects = chosen(formats.load(path), self._options.object)
        if path.resolve() != self._options.source.resolve():
            return report_each(objects, self._divide)
        shown = bpy.data.objects[reference.name]
        return report_each(objects, lambda obj: self._show(obj) if obj == shown else self._divide(obj, shown))

    @cached_property
    def _reference(self) -> Reference:
        try:
            return _prepare(self._options)
        except (Refusal, EngineError) as error:
            raise Refusal(f"the reference {self._options.source}: {error}") from error

    def _show(self, obj: bpy.types.Object) -> Report:
        """Divide the reference itself."""
        reference = self._reference
        warnings = store(obj.data, reference.outcome)
        labels = part_writer.segment_mesh(obj.data, level=reference.level, mode=reference.mode)
        return row_of(obj, labels, reference.outcome, warnings)

    def _divide(self, obj: bpy.types.Object, reference_object: bpy.types.Object | None = None) -> Report:
        """Give a mesh the parts of the reference, which is an object of the same file or of another."""
        reference, mesh = self._reference, obj.data
        part_writer.refuse_foreign_results(mesh)
        analysis, outcome = _analyze(mesh, self._options)
        first_free = max(self._first_free, reference.highest_label + 1)
        found = register_analyzed(reference.prepared, analysis, outcome, self._wish, first_free)
        self._first_free = max(first_free, int(found.labels.parts.id.max()) + 1)
        warnings = store(mesh, outcome)
        settings = {**analysis_settings(self._options), "use_modifiers": False}
        match = match_of(found, reference.name, self._wish, settings)
        registration_record.remember(mesh, reference.tables, match, reference_object)
        part_writer.show_labels(mesh, found.labels, outcome.stored.part_tree, reference.mode)
        return self._row(obj, found, warnings)

    def _row(self, obj: bpy.types.Object, found: Found, warnings: tuple[str, ...]) -> Report:
        row = row_of(obj, found.labels, found.outcome, warnings)
        for part in row["parts"]:
            part["matched"] = part["id"] <= self._reference.highest_label
        return row | {"reference": self._reference.name, "confidence": round(float(found.matching.confidence), 4)}


def _prepare(options: argparse.Namespace) -> Reference:
    obj = chosen(formats.load(options.source), options.reference)[0]
    mesh = obj.data
    part_writer.refuse_foreign_results(mesh)
    registration_record.refuse_registered(mesh)
    mode = options.mode or state.mode_of(mesh)
    shown = _shown_level(mesh)
    analysis, outcome = _analyze(mesh, options)
    store(mesh, outcome)
    choice = choice_of(options) or ({"level": shown} if shown is not None else {})
    labels = part_writer.segment_mesh(mesh, mode=mode, **choice)
    shape = compute.divisible(analysis, compute.matching_shape(analysis), outcome.polygon_of_triangle)
    # As they are shown, with what the user corrected.
    faces = mesh_arrays.read_own_integers(mesh, part_writer.PART).astype(np.int64)
    prepared = compute.with_parts(shape, faces, labels.parts, labels.level)
    return Reference(obj.name, outcome, labels.level, mode, prepared, registration_record.tables_of(mesh))


def _shown_level(mesh: bpy.types.Mesh) -> int | None:
    """Return the level of a mesh that was divided before, as it was left by the user."""
    try:
        state.load(mesh)
        return state.summarize(mesh).level
    except Refusal:
        return None


def _analyze(mesh: bpy.types.Mesh, given: argparse.Namespace) -> tuple[compute.Analysis, Outcome]:
    start = time.perf_counter()
    arrays, options = mesh_arrays.read_mesh(mesh), engine_options(mesh, given)
    analysis = compute.analyze(compute.TriangleMesh(arrays.vertices, arrays.triangles), **options)
    return analysis, outcome_of(analysis, arrays, options, time.perf_counter() - start)
