"""Base class of the operators that show the field itself: parts are stored on the mesh, the field is not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import bpy

from ... import compute
from ..blender.known_values import present
from ..blender.outcome import Outcome
from ..jobs import recent_analyses
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data.world_shape import Stretch
from ..messages.sentences import Messages
from .analysis_request import AnalysisRequest
from .analysis_settings import AnalysisInput, read_input


@dataclass(frozen=True, eq=False)
class AnalyzedShape:
    """The analysis of a shape, and the stretch from its mesh to it."""

    analysis: compute.Analysis
    stretch: Stretch


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


def analyze_topology(given: AnalysisInput, progress: compute.Progress) -> AnalyzedShape:
    """Return an analysis with its persistence diagram; knows nothing of Blender, so any process may do it."""
    analysis = recent_analyses.recall(given.arrays, given.options, progress)
    # The longer part of the topology is made here, in the worker.
    _ = analysis.diagram
    return AnalyzedShape(analysis, given.arrays.stretch)
