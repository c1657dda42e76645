"""Warnings and refusals of the setters of properties, for the panel: a property cannot report."""

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

import bpy

from ...compute.errors import EngineError
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_with
from ..blender.registered_settings import job_status
from ..messages.unexpected_errors import OUT_OF_MEMORY
from ..messages.user_errors import LINKED, is_linked

Settings = TypeVar("Settings", bound=bpy.types.PropertyGroup)
Value = TypeVar("Value")


def shown_in_panel(
    setter: Callable[[Settings, Value], tuple[str, ...] | None],
) -> Callable[[Settings, Value], None]:
    """Let the panel show the warnings that a setter returns and its refusals; it does nothing on a linked mesh."""

    @wraps(setter)
    def set_property(settings: Settings, value: Value) -> None:
        status, mesh = job_status(bpy.context), mesh_with(settings)
        status.problem, status.problem_of = "", mesh.name_full
        if is_linked(mesh):
            status.problem = LINKED
            return
        try:
            status.problem = " ".join(setter(settings, value) or ())
        except (Refusal, EngineError) as error:
            status.problem = str(error)
        except MemoryError:
            status.problem = OUT_OF_MEMORY

    return set_property
