"""Base class of the operators that analyze the active mesh."""

import bpy

from ..blender.outcome import Outcome
from ..blender.registered_settings import analysis_settings
from ..jobs import background
from ..jobs.background import BackgroundOperator
from ..messages.user_errors import can_use_active_mesh
from .analysis_options import AnalysisOptions
from .analysis_settings import SETTINGS, AnalysisSettings


class AnalysisRequest(AnalysisOptions, BackgroundOperator):
    """Analyzes the active mesh in the background."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return background.can_start_job(cls) and can_use_active_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        """From the window: what the call leaves open is taken from the panel."""
        for name in AnalysisOptions.__annotations__:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(analysis_settings(context), name))
        return super().invoke(context, event)

    def analysis_settings(self) -> AnalysisSettings:
        """Return the properties of the operator as values."""
        return AnalysisSettings(**{name: getattr(self, name) for name in SETTINGS})
