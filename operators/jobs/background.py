"""Run an operator's long work in the background of the window: progress, ESC, one job at a time."""

from collections.abc import Callable
from typing import Any

import bpy

from ...compute.progress import Progress, silent
from ..blender.known_values import present
from ..blender.mixins import OperatorMixin
from ..blender.outcome import Outcome
from ..blender.registered_settings import job_status
from ..messages import unexpected_errors
from ..messages.sentences import in_language, tell
from ..messages.unexpected_errors import errors_told
from ..messages.user_errors import refusals_told
from .job import NO_WORKER, Job, Result

# Seconds between looks at the job; it tells of progress less often, so that drawing takes no time from it.
INTERVAL = 0.05

_running: Job[Any] | None = None


class BackgroundOperator(OperatorMixin):
    """Base class of long operators; they give ``begin`` and ``finish``.

    ``begin(context)`` reads what is needed and returns work that never touches Blender and a handle for ``finish``;
    ``finish(context, handle, result)`` writes the result. Scripts wait for the work; the window lets the worker process
    do it, so work and result are made of values and of functions of modules.
    """

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Any], Any]:
        """Read what is needed, and return the work and a handle."""
        raise NotImplementedError

    def finish(self, context: bpy.types.Context, handle: Any, result: Any) -> Outcome:
        """Write the result of the work."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            work, handle = self.begin(context)
            return self.finish(context, handle, work(silent))
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        if bpy.app.background:
            return self.execute(context)
        unexpected_errors.forget()
        with errors_told(self):
            work, self._handle = self.begin(context)
            self._job = _start(work)
            self._timer = present(context.window_manager).event_timer_add(INTERVAL, window=context.window)
            present(context.window_manager).progress_begin(0, 100)
            present(context.window_manager).modal_handler_add(self)
            # Scripts that ask at once are told that it runs.
            _show_progress(context, type(self).bl_idname, self._job)
            return {"RUNNING_MODAL"}
        return {"CANCELLED"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        if event.type == "ESC" and event.value == "PRESS":
            self._job.cancel()
        if self._job is not _running or self._job.is_cancelled:
            self._leave(context)
            tell(self, "INFO", "Cancelled; nothing was changed.")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        if not self._job.look():
            _show_progress(context, type(self).bl_idname, self._job)
            return {"PASS_THROUGH"}
        self._leave(context)
        with errors_told(self):
            outcome = self.finish(context, self._handle, self._job.result())
            if self._job.is_in_blender:
                tell(self, "WARNING", NO_WORKER)
            return outcome
        return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator, such as when a file is loaded."""
        self._leave(context)

    def _leave(self, context: bpy.types.Context) -> None:
        stop_running_job()
        present(context.window_manager).event_timer_remove(self._timer)
        present(context.window_manager).progress_end()
        present(context.workspace).status_text_set(None)
        job_status(context).is_running = False
        _redraw_sidebars(context)


def is_running() -> bool:
    """Whether a job is under way."""
    return _running is not None


def can_start_job(operator: type[bpy.types.Operator]) -> bool:
    """Whether no job is under way; if one is, the tooltip says so."""
    if is_running():
        operator.poll_message_set("Another job is running; wait for it or cancel it.")
    return not is_running()


def stop_running_job() -> None:
    """End the running job, if there is one; its operator notices at the next tick."""
    global _running
    if _running is not None:
        _running.cancel()
    _running = None


def _start(work: Callable[[Progress], Result]) -> Job[Result]:
    global _running
    _running = job = Job(work)
    return job


def _show_progress(context: bpy.types.Context, operator: str, job: Job[Any]) -> None:
    status = job_status(context)
    text = in_language(job.text)
    shown = in_language(f"Eigenparts: {text} ({job.fraction:.0%}), ESC to cancel")
    if status.is_running and status.shown == shown:
        return
    status.is_running, status.job = True, operator
    status.fraction, status.text, status.shown = job.fraction, text, shown
    present(context.window_manager).progress_update(100 * job.fraction)
    present(context.workspace).status_text_set(shown)
    _redraw_sidebars(context)


def _redraw_sidebars(context: bpy.types.Context) -> None:
    for window in present(context.window_manager).windows:
        for area in window.screen.areas:
            for region in area.regions:
                if area.type == "VIEW_3D" and region.type == "UI":
                    region.tag_redraw()
