"""Progress of the running job, for the panel."""

import bpy
from bpy.props import BoolProperty, FloatProperty, PointerProperty, StringProperty


class EigenpartsJobStatus(bpy.types.PropertyGroup):
    """Progress of the running job, whether parts are being picked, and the last problem, for the panel."""

    is_running: BoolProperty(options={"SKIP_SAVE"})
    job: StringProperty(options={"SKIP_SAVE"})
    is_picking: BoolProperty(options={"SKIP_SAVE"})
    fraction: FloatProperty(options={"SKIP_SAVE"}, subtype="FACTOR", min=0, max=1)
    text: StringProperty(options={"SKIP_SAVE"})
    shown: StringProperty(options={"SKIP_SAVE"})
    problem: StringProperty(options={"SKIP_SAVE"})
    problem_of: StringProperty(description="Name of the mesh that has the problem", options={"SKIP_SAVE"})


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsJobStatus,))


def register() -> None:
    """Give the window manager the status."""
    _register_classes()
    bpy.types.WindowManager.eigenparts = PointerProperty(type=EigenpartsJobStatus)


def unregister() -> None:
    """Take it away again."""
    del bpy.types.WindowManager.eigenparts
    _unregister_classes()
