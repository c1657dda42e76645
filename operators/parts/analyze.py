"""Operator: find the features of a mesh and divide it into parts at the default level."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import bpy

from ...tasks import mesh_analysis, recent_analyses
from ...tasks.mesh_analysis import AnalysisResult
from ..blender.known_values import present
from ..blender.outcome import Outcome
from ..blender.registered_settings import job_status
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data.viewport import show_vertex_colours
from . import mesh_segmentation
from .analysis_request import AnalysisRequest


class EIGENPARTS_OT_analyze(AnalysisRequest, bpy.types.Operator):
    """Find what protrudes on the active mesh, such as limbs, heads and fingers, and divide it into parts"""

    bl_idname = "eigenparts.analyze"
    bl_label = "Analyze"
    bl_options = {"UNDO"}

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., AnalysisResult], MeshHandle]:
        given = mesh_segmentation.read(context, present(context.object), self.analysis_settings())
        analyze = partial(mesh_analysis.analyze, given, analysis_of=recent_analyses.analyze_and_keep)
        return analyze, MeshHandle.of(present(context.object))

    def finish(self, context: bpy.types.Context, handle: MeshHandle, result: AnalysisResult) -> Outcome:
        segmented = mesh_segmentation.write(handle.find_mesh(), result)
        show_vertex_colours(context)
        job_status(context).problem = ""
        segmented.messages.report(self)
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_analyze,))
