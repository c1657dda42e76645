"""Operator: stop the running job."""

import bpy

from ..blender.outcome import Outcome
from . import background, worker_process


class EIGENPARTS_OT_cancel(bpy.types.Operator):
    """Stop the running job; nothing is changed"""

    bl_idname = "eigenparts.cancel"
    bl_label = "Cancel"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return background.is_running()

    def execute(self, context: bpy.types.Context) -> Outcome:
        background.stop_running_job()
        return {"FINISHED"}


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EIGENPARTS_OT_cancel,))


def register() -> None:
    """Add the operator."""
    _register_classes()


def unregister() -> None:
    """Remove the operator; the extension goes, so a job has nobody left to report to."""
    background.stop_running_job()
    worker_process.end_session()
    _unregister_classes()
