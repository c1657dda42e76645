"""Base class of the operators that show the field itself: parts are stored on the mesh, the field is not."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import bpy

from ...tasks.mesh_analysis import AnalyzedShape, analyze_topology
from ..blender.known_values import present
from ..blender.outcome import Outcome
from ..jobs.mesh_handle import MeshHandle
from ..messages.sentences import Messages
from .analysis_request import AnalysisRequest
from .analysis_settings import read_input


class FreshAnalysis(AnalysisRequest):
    """Analyzes the active mesh, and hands the analysis to ``show``."""

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., AnalyzedShape], MeshHandle]:
        given = read_input(context, present(context.object), self.analysis_settings())
        return partial(analyze_topology, given), MeshHandle.of(present(context.object))

    def finish(self, context: bpy.types.Context, handle: MeshHandle, shape: AnalyzedShape) -> Outcome:
        shown = self.show(context, handle.find_object(), shape)
        Messages((shown,), shape.analysis.warnings).report(self)
        return {"FINISHED"}

    def show(self, context: bpy.types.Context, obj: bpy.types.Object, shape: AnalyzedShape) -> str:
        """Show something of the analysis of an object, and return a sentence about it."""
        raise NotImplementedError
