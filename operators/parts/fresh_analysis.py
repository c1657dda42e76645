"""What operators have in common that show the field itself: parts are stored on the mesh, the field is not."""

from collections.abc import Callable
from functools import partial
from typing import Any

import bpy

from ..jobs import recent_analyses
from ..mesh_data import mesh_arrays
from .analysis_request import AnalysisRequest


class FreshAnalysis(AnalysisRequest):
    """Hands an analysis of the active mesh to ``finish`` with the name of the object."""

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Any], str]:
        return partial(self.examine, *self.read(context)), context.object.name

    @staticmethod
    def examine(arrays: mesh_arrays.MeshArrays, options: dict[str, Any], progress: Callable[[float, str], None]) -> Any:
        """Return what ``finish`` needs; knows nothing of Blender, so any thread may do it."""
        analysis = recent_analyses.recall(arrays, options, progress)
        # The longer part of the topology is made here, in the thread.
        _ = analysis.diagram
        return analysis
