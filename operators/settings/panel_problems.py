"""What the panel says when a property of a mesh cannot be set: a property cannot report."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import bpy

from ...compute.errors import EngineError
from ..messages.unexpected_errors import OUT_OF_MEMORY
from ..messages.user_errors import LINKED, Refusal, is_linked

# Sets a property of a mesh, or of something on it, and may return warnings.
Setter = Callable[[Any, Any], tuple[str, ...] | None]


def shown_in_panel(setter: Setter) -> Callable[[Any, Any], None]:
    """Let the panel show the warnings and refusals of a setter, which does nothing on a linked mesh."""

    @wraps(setter)
    def set_property(settings: Any, value: Any) -> None:
        status, mesh = bpy.context.window_manager.eigenparts, settings.id_data
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
