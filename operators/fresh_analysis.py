"""What operators have in common that show the field itself: parts are stored on the mesh, the field is not."""

from collections.abc import Callable
from functools import partial
from typing import Any

import bpy

from . import background, engine, exchange
from .analyze import analysis_options
from .background import BackgroundOperator
from .properties import AnalysisOptions
from .refusals import can_use_active_mesh


class FreshAnalysis(AnalysisOptions, BackgroundOperator):
    """Analyzes the active mesh anew and hands the analysis to ``finish`` with the name of the object."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if background.is_running():
            cls.poll_message_set("Another job is running; wait for it or cancel it.")
            return False
        return can_use_active_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """From the window: what the call leaves open is taken from the panel."""
        for name in AnalysisOptions.__annotations__:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.scene.eigenparts, name))
        return super().invoke(context, event)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Any], str]:
        mesh = context.object.data
        if self.use_modifiers:
            arrays = exchange.read_evaluated_mesh(context.object, context.evaluated_depsgraph_get())
        else:
            arrays = exchange.read_mesh(mesh)
        options = analysis_options(
            mesh, self.field, self.eigenfunction, self.attribute, order=self.order, boundary=self.boundary
        )
        return partial(self.examine, arrays, options), context.object.name

    @staticmethod
    def examine(arrays: exchange.MeshArrays, options: dict[str, Any], progress: Callable[[float, str], None]) -> Any:
        """Return what ``finish`` needs; knows nothing of Blender, so any thread may do it."""
        analysis = engine.analyze(engine.TriangleMesh(arrays.vertices, arrays.triangles), **options, progress=progress)
        # The longer part of the topology is made here, in the thread.
        _ = analysis.diagram
        return analysis
