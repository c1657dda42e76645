"""Operator: find the features of a mesh and divide it into parts at the default level."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import bpy
import numpy as np

from ... import compute
from ..jobs import recent_analyses
from ..mesh_data import mesh_arrays
from ..mesh_data.viewport import show_vertex_colours
from ..mesh_state import function_hints, state
from ..messages.sentences import tell
from ..messages.user_errors import Refusal
from ..outputs import part_writer
from ..outputs.rollback import all_or_nothing
from .analysis_request import AnalysisRequest


@dataclass(frozen=True)
class Ticket:
    """Where a result belongs; names and pointers do not survive undo, these do."""

    session_uid: int
    fingerprint: str


@dataclass(frozen=True, eq=False)
class Outcome:
    """What an analysis leaves for the mesh."""

    stored: state.StoredAnalysis
    source: state.BorderSource
    description: str
    warnings: tuple[str, ...]
    seconds: float
    polygon_of_triangle: np.ndarray
    hints: tuple[compute.FunctionHint, ...] = ()


class EIGENPARTS_OT_analyze(AnalysisRequest, bpy.types.Operator):
    """Find what protrudes on the active mesh, such as limbs, heads and fingers, and divide it into parts"""

    bl_idname = "eigenparts.analyze"
    bl_label = "Analyze"
    bl_options = {"UNDO"}

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Outcome], Ticket]:
        mesh = context.object.data
        part_writer.refuse_foreign_results(mesh)
        ticket = Ticket(mesh.session_uid, mesh_arrays.fingerprint(mesh))
        return partial(_analyze_and_keep, *self.read(context)), ticket

    def finish(self, context: bpy.types.Context, ticket: Ticket, outcome: Outcome) -> set[str]:
        mesh = find_mesh(ticket)
        with all_or_nothing(mesh):
            told = state.store(mesh, outcome.stored, outcome.source, outcome.description)
            function_hints.store(mesh, outcome.hints)
            labels = part_writer.segment_mesh(mesh)
        show_vertex_colours(context)
        context.window_manager.eigenparts.problem = ""
        for warning in (*outcome.warnings, *told, *labels.warnings):
            tell(self, "WARNING", warning)
        tell(self, "INFO", _told(len(labels.parts), outcome.seconds), function_hints.sentence(mesh))
        return {"FINISHED"}


def analyze_arrays(
    arrays: mesh_arrays.MeshArrays,
    options: dict[str, Any],
    progress: Callable[[float, str], None],
    analyze: Callable[..., compute.Analysis] = recent_analyses.analyze,
) -> Outcome:
    """Run the engine; knows nothing of Blender, so any thread may do it."""
    start = time.perf_counter()
    analysis = analyze(arrays, options, progress)
    return outcome_of(analysis, arrays, options, time.perf_counter() - start)


def _analyze_and_keep(
    arrays: mesh_arrays.MeshArrays, options: dict[str, Any], progress: Callable[[float, str], None]
) -> Outcome:
    return analyze_arrays(arrays, options, progress, recent_analyses.analyze_and_keep)


def outcome_of(
    analysis: compute.Analysis, arrays: mesh_arrays.MeshArrays, options: dict[str, Any], seconds: float
) -> Outcome:
    """Return what of an analysis is left for the mesh; knows nothing of Blender either."""
    stored = state.StoredAnalysis(analysis.part_tree(arrays.polygon_of_triangle), options["shells"])
    heights = compute.vertex_heights(analysis.surface, analysis.field)
    source = state.BorderSource(analysis.profile(arrays.edges), heights)
    is_function = isinstance(options["field"], int)
    hints = compute.judge_eigenfunctions(analysis.eigenbasis) if is_function else ()
    described = _described(options)
    return Outcome(stored, source, described, analysis.warnings, seconds, arrays.polygon_of_triangle, hints)


def _described(options: dict[str, Any]) -> str:
    field = options["field"]
    if isinstance(field, int):
        return f"Eigenfunction {field}"
    return "Diffusion" if isinstance(field, str) else "Own values"


def find_mesh(ticket: Ticket) -> bpy.types.Mesh:
    """Return the mesh that a result belongs to, if it is still as it was."""
    mesh = next((mesh for mesh in bpy.data.meshes if mesh.session_uid == ticket.session_uid), None)
    if mesh is None:
        raise Refusal("The mesh was deleted while it was analyzed.")
    if mesh.is_editmode:
        raise Refusal("The mesh was taken into edit mode while it was analyzed; leave edit mode and analyze it again.")
    if mesh_arrays.fingerprint(mesh) != ticket.fingerprint:
        raise Refusal("The mesh was edited while it was analyzed; analyze it again.")
    return mesh


def _told(n_parts: int, seconds: float) -> str:
    if n_parts == 1:
        return f"No features: the mesh is one part ({seconds:.1f} s)."
    return f"{n_parts} parts ({seconds:.1f} s)."


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_analyze,))
