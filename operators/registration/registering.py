"""What operators have in common that register meshes to a reference."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import bpy

from ..jobs.background import BackgroundOperator
from ..mesh_data import mesh_arrays
from ..mesh_data.viewport import show_vertex_colours
from ..mesh_state import corrected_analysis, registration_record, state
from ..messages.sentences import tell
from ..messages.user_errors import Refusal, in_name_of, refuse_unwritable
from ..outputs import part_writer
from ..outputs.rollback import all_or_nothing
from ..parts.analysis_options import AnalysisOptions
from ..parts.analysis_request import analysis_options
from ..parts.analyze import Ticket, find_mesh
from .register_meshes import (
    CORRECTED_BEFORE,
    SHOWN_FUNCTIONS,
    Found,
    Registration,
    Shown,
    Subject,
    Wish,
    register_subjects,
)

SETTINGS = tuple(AnalysisOptions.__annotations__)


@dataclass(frozen=True)
class Tickets:
    """Where the results belong, and what is remembered with them."""

    reference: Ticket
    reference_uid: int
    names: tuple[str, ...]
    targets: tuple[Ticket, ...]
    wish: Wish
    settings: dict[str, Any]


class Registers(BackgroundOperator):
    """Registers objects to another; operators give ``begin``, which returns ``self.start(...)``."""

    def start(
        self,
        context: bpy.types.Context,
        reference: bpy.types.Object,
        targets: list[bpy.types.Object],
        wish: Wish,
        settings: dict[str, Any],
    ) -> tuple[Callable[..., Registration], Tickets]:
        """Read all meshes; whatever stands in the way is told now."""
        _refuse_registered(reference)
        subjects = [_read(context, obj, settings) for obj in (reference, *targets)]
        tickets = [Ticket(obj.data.session_uid, mesh_arrays.fingerprint(obj.data)) for obj in (reference, *targets)]
        shown, first_free = _shown(reference), _first_free_label(context, reference, targets)
        work = partial(register_subjects, subjects[0], shown, subjects[1:], wish, first_free)
        names = tuple(obj.name for obj in targets)
        return work, Tickets(tickets[0], reference.session_uid, names, tuple(tickets[1:]), wish, settings)

    def finish(self, context: bpy.types.Context, tickets: Tickets, registration: Registration) -> set[str]:
        reference, *meshes = (find_mesh(ticket) for ticket in (tickets.reference, *tickets.targets))
        obj = _object(tickets.reference_uid)
        for mesh in (reference, *meshes):
            part_writer.refuse_foreign_results(mesh)
        with all_or_nothing(reference, *meshes):
            _write(reference, meshes, obj, tickets, registration)
        show_vertex_colours(context)
        context.window_manager.eigenparts.problem = ""
        self._tell(obj.name, tickets.names, registration)
        return {"FINISHED"}

    def _tell(self, reference: str, names: tuple[str, ...], registration: Registration) -> None:
        confidences = [found.matching.confidence for found in registration.found]
        lowest = min(confidences)
        name = names[confidences.index(lowest)]
        if len(names) == 1:
            tell(self, "INFO", f"Registered 1 object to {reference}; least sure: {name}, {lowest:.0%}.")
        else:
            tell(self, "INFO", f"Registered {len(names)} objects to {reference}; least sure: {name}, {lowest:.0%}.")
        if lowest <= registration_record.SURE:
            tell(self, "WARNING", f"{name} is matched with a confidence of {lowest:.0%} only; look at its parts.")


def _write(
    reference: bpy.types.Mesh,
    meshes: list[bpy.types.Mesh],
    obj: bpy.types.Object,
    tickets: Tickets,
    registration: Registration,
) -> None:
    _store(reference, registration.reference)
    part_writer.segment_mesh(reference, level=registration.level)
    tables = registration_record.tables_of(reference)
    for mesh, found in zip(meshes, registration.found, strict=True):
        _store(mesh, found.outcome)
        registration_record.remember(mesh, tables, match_of(found, obj.name, tickets.wish, tickets.settings), obj)
        part_writer.show_labels(mesh, found.labels, found.outcome.stored.part_tree, state.mode_of(mesh))


def _object(session_uid: int) -> bpy.types.Object:
    obj = next((obj for obj in bpy.data.objects if obj.session_uid == session_uid), None)
    if obj is None:
        raise Refusal("The object that has the parts was deleted meanwhile.")
    return obj


def _refuse_registered(reference: bpy.types.Object) -> None:
    match = registration_record.read(reference.data)
    if match is not None:
        raise Refusal(
            f"{reference.name} shows the parts of {match.reference}; make that one the active object, or move the level"
            f" of {reference.name} first, so that it has parts of its own."
        )


def _store(mesh: bpy.types.Mesh, outcome: Any) -> None:
    state.store(mesh, outcome.stored, outcome.source, outcome.description)


def _read(context: bpy.types.Context, obj: bpy.types.Object, settings: dict[str, Any]) -> Subject:
    """Return what of an object goes into the job, or say by its name why nothing can."""
    with in_name_of(obj.name):
        refuse_unwritable(obj.data)
        part_writer.refuse_foreign_results(obj.data)
        arrays = mesh_arrays.read_object(context, obj, settings["use_modifiers"])
        options = {name: settings[name] for name in SETTINGS if name != "use_modifiers"}
        return Subject(obj.name, arrays, analysis_options(obj.data, **options))


def _shown(reference: bpy.types.Object) -> Shown:
    mesh = reference.data
    try:
        return Shown(state.summarize(mesh).level, state.mode_of(mesh), corrected_analysis.load(mesh))
    except Refusal:
        if corrected_analysis.items_of(mesh):
            raise Refusal(CORRECTED_BEFORE.format(reference.name)) from None
        return Shown(None, state.mode_of(mesh), None)


def _first_free_label(context: bpy.types.Context, reference: bpy.types.Object, targets: list[bpy.types.Object]) -> int:
    """Return a label above all that others have which are registered to the same reference."""
    labels = [
        label
        for obj, _ in registration_record.registered_objects(context)
        if registration_record.reference_object(obj.data) == reference and obj not in targets
        for label, _, _ in state.summarize(obj.data).parts
    ]
    return 1 + max(labels, default=0)


def match_of(found: Found, reference: str, wish: Wish, settings: dict[str, Any]) -> registration_record.Match:
    """Return what a mesh remembers of how it was registered."""
    matching = found.matching
    return registration_record.Match(
        reference=reference,
        confidence=float(matching.confidence),
        order=tuple((1 + matching.order[:SHOWN_FUNCTIONS]).tolist()),
        signs=tuple(matching.signs[:SHOWN_FUNCTIONS].tolist()),
        flips={str(number): sign for number, sign in wish.flips.items()},
        alternative=found.alternative,
        n_alternatives=found.n_alternatives,
        mirrored=matching.mirrored,
        same_topology=matching.same_topology,
        settings=settings,
        by_diagrams=found.by_diagrams,
    )
