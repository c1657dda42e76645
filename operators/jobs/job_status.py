"""Progress of the running job, for the panel."""

import bpy
from bpy.props import PointerProperty

from ..blender.registered_settings import SETTINGS
from ..blender.typed_properties import BoolProperty, FloatProperty, StringProperty, TypedProperties


class EigenpartsJobStatus(TypedProperties, bpy.types.PropertyGroup):
    """Progress of the running job, whether parts are being picked, and the last problem, for the panel."""

    is_running: bool = BoolProperty(options={"SKIP_SAVE"})
    job: str = StringProperty(options={"SKIP_SAVE"})
    is_picking: bool = BoolProperty(options={"SKIP_SAVE"})
    fraction: float = FloatProperty(options={"SKIP_SAVE"}, subtype="FACTOR", min=0, max=1)
    text: str = StringProperty(options={"SKIP_SAVE"})
    shown: str = StringProperty(options={"SKIP_SAVE"})
    problem: str = StringProperty(options={"SKIP_SAVE"})
    problem_of: str = StringProperty(description="Name of the mesh that has the problem", options={"SKIP_SAVE"})


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsJobStatus,))


def register() -> None:
    """Give the window manager the status."""
    _register_classes()
    setattr(bpy.types.WindowManager, SETTINGS, PointerProperty(type=EigenpartsJobStatus))


def unregister() -> None:
    """Take it away again."""
    delattr(bpy.types.WindowManager, SETTINGS)
    _unregister_classes()
