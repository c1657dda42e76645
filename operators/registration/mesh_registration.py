"""Use case: meshes registered to a reference, the same from the window, from scripts and on the command line.

``read_reference`` and ``read_target`` take what is needed from objects, `shape_registration` computes on values alone,
``write_reference`` and ``write_target`` put the result on meshes and return what is to be told.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass

import bpy

from ... import compute
from ...tasks.level_choice import LevelChoice
from ...tasks.match_options import MatchOptions
from ...tasks.mesh_analysis import AnalysisInput
from ...tasks.refusals import Refusal, in_name_of
from ...tasks.shape_registration import CORRECTED_BEFORE, PreparedReference, RegisteredShape, Registration, ShownParts
from ..blender.known_values import mesh_of, present
from ..mesh_data.unfinished_meshes import modifiers_that_add, unfinished
from ..mesh_data.world_shape import users_of
from ..mesh_state import registration_record
from ..mesh_state.corrected_analysis import corrected
from ..mesh_state.part_table import PartTable
from ..mesh_state.references import registered_objects
from ..mesh_state.state import MeshState, read
from ..messages.sentences import Messages
from ..messages.user_errors import refuse_unwritable
from ..outputs import output_registry, part_writer
from ..outputs.rollback import all_or_nothing
from ..parts import mesh_segmentation
from ..parts.analysis_settings import AnalysisSettings
from ..parts.mesh_segmentation import Segmented

# Functions whose signs can be given, and that are shown.
SHOWN_FUNCTIONS = 8
NO_REFERENCE = "The object that has the parts was deleted meanwhile."


@dataclass(frozen=True, eq=False)
class SharedParts:
    """The parts of a reference as other meshes show them, and how these were asked for.

    Attributes
    ----------
    reference : str
        Name of the object.
    mode : str
    parts : PartTable
        Names and colours.
    warnings : tuple of str
        To be told of the reference, beginning with its name.
    options : MatchOptions
    settings : AnalysisSettings
    """

    reference: str
    mode: str
    parts: PartTable
    warnings: tuple[str, ...]
    options: MatchOptions
    settings: AnalysisSettings


def read_reference(
    context: bpy.types.Context,
    obj: bpy.types.Object,
    settings: AnalysisSettings,
    *,
    mode: str | None = None,
    choice: LevelChoice | None = None,
) -> tuple[AnalysisInput, ShownParts]:
    """Return what the analysis of a reference needs, and the parts that it is to show.

    Parameters
    ----------
    mode : str, optional
        How levels are read; as the mesh shows them if None.
    choice : LevelChoice, optional
        One of ``level``, ``threshold`` and ``n_parts``; the level that the mesh shows if there is none.
    """
    state = read(mesh_of(obj))
    _refuse_registered(obj, state)
    mode, choice = mode or state.mode, choice or {}
    try:
        shown = ShownParts(mode, choice, state.level, corrected(state))
    except Refusal:
        if state.corrections:
            raise Refusal(CORRECTED_BEFORE.format(obj.name)) from None
        shown = ShownParts(mode, choice)
    return read_target(context, obj, settings), shown


def read_target(context: bpy.types.Context, obj: bpy.types.Object, settings: AnalysisSettings) -> AnalysisInput:
    """Return what the analysis of an object needs, or say by its name why there can be none."""
    with in_name_of(obj.name):
        refuse_unwritable(mesh_of(obj))
        read(mesh_of(obj)).refuse_newer()
        return mesh_segmentation.read(context, obj, settings)


def first_free_label(context: bpy.types.Context, reference: bpy.types.Object, targets: list[bpy.types.Object]) -> int:
    """Return a label above all that others have which are registered to the same reference."""
    labels = [
        label
        for obj, state in registered_objects(context)
        if present(state.registration).reference == reference and obj not in targets
        for label in state.summary.shares
    ]
    return 1 + max(labels, default=0)


def write_all(
    obj: bpy.types.Object,
    meshes: list[bpy.types.Mesh],
    registration: Registration,
    options: MatchOptions,
    settings: AnalysisSettings,
) -> Messages:
    """Write a reference and all that were registered to it, or nothing."""
    with all_or_nothing(mesh_of(obj), *meshes):
        shown = write_reference(obj, registration.reference)
        shared = shared_parts(obj, registration.reference, shown, options, settings)
        written = [
            write_target(mesh, shape, shared, obj) for mesh, shape in zip(meshes, registration.shapes, strict=True)
        ]
    warnings = tuple(warning for messages in written for warning in messages.warnings)
    return Messages((_summary(obj.name, registration.shapes),), warnings)


def write_reference(obj: bpy.types.Object, reference: PreparedReference) -> Segmented:
    """Let a reference show its parts; all of them are written or nothing."""
    output_registry.refuse_foreign_results(read(mesh_of(obj)))
    shown = mesh_segmentation.write(
        mesh_of(obj), reference.result, mode=reference.mode, choice={"level": reference.level}
    )
    warnings = _in_name_of(obj.name, shown.messages.warnings)
    return Segmented(shown.labels, Messages(shown.messages.infos, warnings))


def shared_parts(
    obj: bpy.types.Object,
    reference: PreparedReference,
    shown: Segmented,
    options: MatchOptions,
    settings: AnalysisSettings,
) -> SharedParts:
    """Return the parts of a reference that ``write_reference`` wrote, for the meshes that are to show them."""
    return SharedParts(
        reference=obj.name,
        mode=reference.mode,
        parts=read(mesh_of(obj)).parts,
        warnings=shown.messages.warnings,
        options=options,
        settings=settings,
    )


def write_target(
    mesh: bpy.types.Mesh, shape: RegisteredShape, shared: SharedParts, reference: bpy.types.Object | None
) -> Messages:
    """Let a mesh show the parts of a reference; all of them are written or nothing.

    Parameters
    ----------
    reference : Object or None
        The object that is the reference, None if it is in another file.
    """
    output_registry.refuse_foreign_results(read(mesh))
    with all_or_nothing(mesh):
        told = mesh_segmentation.store(mesh, shape.result)
        part_writer.show_registered(
            mesh,
            shape.labels,
            shape.result.stored.part_tree,
            shared.parts,
            match_of(shape, shared),
            reference,
            mode=shared.mode,
        )
    warnings = _in_name_of(shape.name, (*shape.result.warnings, *told, *shape.labels.warnings))
    objects = [obj for obj in (*users_of(mesh)[:1], reference) if obj is not None]
    return Messages(warnings=(*shared.warnings, *warnings, *_doubts(shape, objects)))


def match_of(shape: RegisteredShape, shared: SharedParts) -> registration_record.Match:
    """Return what a mesh remembers of how it was registered."""
    matching = shape.matching
    return registration_record.Match(
        reference=shared.reference,
        confidence=float(matching.confidence),
        order=tuple((1 + matching.order[:SHOWN_FUNCTIONS]).tolist()),
        signs=tuple(matching.signs[:SHOWN_FUNCTIONS].tolist()),
        flips={str(number): sign for number, sign in shared.options.flips.items()},
        alternative=shape.alternative,
        n_alternatives=shape.n_alternatives,
        mirrored=matching.mirrored,
        same_topology=matching.same_topology,
        settings=asdict(shared.settings),
        by_diagrams=shape.by_diagrams,
    )


def _refuse_registered(reference: bpy.types.Object, state: MeshState) -> None:
    match = state.match
    if match is not None:
        raise Refusal(
            f"{reference.name} shows the parts of {match.reference}; make that one the active object, or move the level"
            f" of {reference.name} first, so that it has parts of its own."
        )


def _in_name_of(name: str, warnings: Iterable[str]) -> tuple[str, ...]:
    return tuple(f"{name}: {warning}" for warning in warnings)


def _summary(reference: str, shapes: tuple[RegisteredShape, ...]) -> str:
    least_sure = min(shapes, key=lambda shape: shape.matching.confidence)
    name, lowest = least_sure.name, least_sure.matching.confidence
    if len(shapes) == 1:
        return f"Registered 1 object to {reference}; least sure: {name}, {lowest:.0%}."
    return f"Registered {len(shapes)} objects to {reference}; least sure: {name}, {lowest:.0%}."


def _doubts(shape: RegisteredShape, objects: list[bpy.types.Object]) -> tuple[str, ...]:
    """Return what is told where a matching is not sure, with what of the objects may be the cause."""
    confidence = shape.matching.confidence
    if confidence > registration_record.SURE:
        return ()
    is_unsure = f"{shape.name} is matched with a confidence of {confidence:.0%} only; look at its parts."
    if not shape.matching.is_consistent:
        is_unsure = f"{shape.name}: {compute.CONTRADICTS}"
    return (is_unsure, *filter(None, (unfinished(obj.name, modifiers_that_add(obj)) for obj in objects)))
