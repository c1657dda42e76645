"""Base class of the operators that register meshes to a reference."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import bpy

from ...tasks.match_options import MatchOptions
from ...tasks.shape_registration import Registration, register_all
from ..blender.outcome import Outcome
from ..blender.registered_settings import job_status
from ..jobs.background import BackgroundOperator
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data.viewport import show_vertex_colours
from ..mesh_state.point_pairs import points_between
from ..parts.analysis_settings import AnalysisSettings
from . import mesh_registration


@dataclass(frozen=True)
class RegistrationHandles:
    """The meshes that results are written to, and what is remembered with them."""

    reference: MeshHandle
    targets: tuple[MeshHandle, ...]
    options: MatchOptions
    settings: AnalysisSettings


class RegistrationOperator(BackgroundOperator):
    """Registers objects to another; operators give ``begin``, which returns ``self.start(...)``."""

    def start(
        self,
        context: bpy.types.Context,
        reference: bpy.types.Object,
        targets: list[bpy.types.Object],
        options: MatchOptions,
        settings: AnalysisSettings,
    ) -> tuple[Callable[..., Registration], RegistrationHandles]:
        """Read all meshes; whatever stands in the way is told now."""
        given, shown = mesh_registration.read_reference(context, reference, settings)
        others = [mesh_registration.read_target(context, obj, settings) for obj in targets]
        each = [replace(options, points=points_between(context, reference, obj)) for obj in targets]
        first_free = mesh_registration.first_free_label(context, reference, targets)
        handles = RegistrationHandles(
            MeshHandle.of(reference), tuple(MeshHandle.of(obj) for obj in targets), options, settings
        )
        return partial(register_all, given, shown, others, each, first_free), handles

    def finish(self, context: bpy.types.Context, handles: RegistrationHandles, registration: Registration) -> Outcome:
        reference = handles.reference.find_object(mesh_registration.NO_REFERENCE)
        meshes = [handle.find_mesh() for handle in handles.targets]
        messages = mesh_registration.write_all(reference, meshes, registration, handles.options, handles.settings)
        show_vertex_colours(context)
        job_status(context).problem = ""
        messages.report(self)
        return {"FINISHED"}
