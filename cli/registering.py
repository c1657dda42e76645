"""The command ``register``: each mesh divided into the parts of a reference."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeAlias

import bpy

from .. import compute
from ..compute.errors import EngineError
from ..compute.progress import silent
from ..operators.blender.known_values import mesh_of
from ..operators.registration import mesh_registration
from ..operators.registration.mesh_registration import SharedParts
from ..tasks import shape_registration
from ..tasks.match_options import MatchOptions
from ..tasks.refusals import Refusal
from ..tasks.shape_registration import MatchableShape, MatchedPair, PreparedReference
from . import formats
from .formats import OpenFile
from .formats.points import points_of, settings_of_points
from .objects import analysis_settings, chosen_objects, report_each, row_of
from .reports.report import ObjectRow, Settings
from .results.digests import digest_of
from .segmenting import choice_of


@dataclass(frozen=True, eq=False)
class Reference:
    """The object whose parts all others get: prepared once, and read from its own file."""

    prepared: PreparedReference
    shared: SharedParts
    # What was mended when it was read.
    repairs: list[str]


# By the name of an object, its shape and how it is matched, or what is wrong with it.
Matched: TypeAlias = dict[str, tuple[MatchableShape, compute.Matching] | Refusal | EngineError]


class Register:
    """Registers files with the options of one call; the reference is prepared when it is first needed."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._first_free = options.first_free

    @cached_property
    def settings(self) -> Settings:
        """All that the results depend on besides the files."""
        options = self._options
        if not options.source.is_file():
            raise Refusal(f"the reference {options.source}: there is no such file.")
        source = {"file": options.source.name, "digest": digest_of(options.source), "object": options.reference}
        given = {name: getattr(options, name) for name in ("object", "field", "shells", "borders", "mode")}
        chosen_parts = {"choice": choice_of(options), "mirrored": options.mirrored}
        return {"command": "register", **given, **chosen_parts, **settings_of_points(options.points), "source": source}

    def open_and_process(self, path: Path) -> tuple[OpenFile, list[ObjectRow]]:
        """Leave a file open with its meshes divided, and return it with a row for each."""
        # The reference opens a file of its own, so it comes first.
        reference = self._reference
        file = chosen_objects(formats.load(path), self._options.object)
        is_source = path.resolve() == self._options.source.resolve()
        shown = bpy.data.objects[reference.prepared.name] if is_source else None
        matched = self._match_all([obj for obj in file.objects if obj != shown])
        return report_each(file, lambda obj: self._show(obj) if obj == shown else self._divide(obj, matched, shown))

    @cached_property
    def _reference(self) -> Reference:
        try:
            return _prepare(self._options)
        except (Refusal, EngineError) as error:
            raise Refusal(f"the reference {self._options.source}: {error}") from error

    def _show(self, obj: bpy.types.Object) -> ObjectRow:
        """Divide the reference itself."""
        prepared = self._reference.prepared
        shown = mesh_registration.write_reference(obj, prepared)
        return row_of(obj, shown.labels, prepared.result, shown.messages)

    def _match_all(self, objects: list[bpy.types.Object]) -> Matched:
        """Return the objects' shapes and how they are matched; of those that cannot be, the error."""
        prepared, shared = self._reference.prepared, self._reference.shared
        shapes: dict[str, MatchableShape] = {}
        errors: Matched = {}
        for obj in objects:
            try:
                given = mesh_registration.read_target(bpy.context, obj, shared.settings)
                shape = shape_registration.matchable_shape(given, silent)
                # By itself first, as one that cannot be matched is to cost no other; its matching is kept.
                shape_registration.match_all(prepared, [shape], [shared.options], silent)
                shapes[obj.name] = shape
            except (Refusal, EngineError) as error:
                errors[obj.name] = error
        options = [shared.options] * len(shapes)
        try:
            matchings = shape_registration.match_all(prepared, list(shapes.values()), options, silent)
        except (Refusal, EngineError) as error:
            return errors | dict.fromkeys(shapes, error)
        return errors | dict(zip(shapes, zip(shapes.values(), matchings, strict=True), strict=True))

    def _divide(self, obj: bpy.types.Object, matched: Matched, reference: bpy.types.Object | None) -> ObjectRow:
        """Give a mesh the parts of the reference, which is an object of the same file or of another."""
        prepared, shared = self._reference.prepared, self._reference.shared
        found = matched[obj.name]
        if isinstance(found, Exception):
            raise found
        first_free = max(self._first_free, prepared.highest_label + 1)
        pair = MatchedPair(obj.name, prepared, *found, shared.options)
        shape = shape_registration.divide(pair, first_free, silent)
        messages = mesh_registration.write_target(mesh_of(obj), shape, shared, reference)
        self._first_free = max(first_free, shape.highest_label + 1)
        row = row_of(obj, shape.labels, shape.result, messages)
        for part in row["parts"]:
            part["matched"] = part["id"] <= prepared.highest_label
        if reference is None:
            row["warnings"] += [f"{prepared.name}: {repair}" for repair in self._reference.repairs]
        row["reference"], row["confidence"] = prepared.name, round(float(shape.matching.confidence), 4)
        return row


def _prepare(options: argparse.Namespace) -> Reference:
    file = chosen_objects(formats.load(options.source), options.reference)
    obj = file.objects[0]
    repairs = file.repairs_of(obj)
    settings = analysis_settings(options)
    given, shown = mesh_registration.read_reference(
        bpy.context, obj, settings, mode=options.mode, choice=choice_of(options)
    )
    shape = shape_registration.matchable_shape(given, silent)
    prepared = shape_registration.prepare_reference(obj.name, shape, shown)
    # Its names and colours are read off the mesh that shows its parts; this file is not written.
    written = mesh_registration.write_reference(obj, prepared)
    match_options = MatchOptions(mirrored=options.mirrored, points=points_of(options.points))
    shared = mesh_registration.shared_parts(obj, prepared, written, match_options, settings)
    return Reference(prepared, shared, repairs)
