"""Sentences for the user instead of tracebacks, at the one place where operators catch errors."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

import bpy

from ...compute.errors import EngineError
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of
from .sentences import tell

MISSING_SCIPY = (
    "Eigenparts needs scipy, which is not installed; "
    "install the Eigenparts zip made for your system and Blender version, or add scipy to Blender's Python."
)
IN_EDIT_MODE = "Leave edit mode first; results are written to the mesh as a whole."
LINKED = "The mesh is linked from another file; make it local first."


def is_engine_complete() -> bool:
    """Whether the libraries of the engine are there; cheap enough for every redraw."""
    return "scipy" in sys.modules or find_spec("scipy") is not None


@contextmanager
def refusals_told(operator: bpy.types.Operator) -> Iterator[None]:
    """Report refusals of ours and of the engine; what stands behind the block then cancels the operator."""
    try:
        yield
    except (Refusal, EngineError) as error:
        tell(operator, "ERROR", str(error))


def refuse_unwritable(mesh: bpy.types.Mesh) -> None:
    """Raise a Refusal if results cannot be written to a mesh."""
    if mesh.is_editmode:
        raise Refusal(IN_EDIT_MODE)
    if is_linked(mesh):
        raise Refusal(LINKED)


def can_use_active_mesh(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether the active object is a mesh that can be read and written; if not, the tooltip says why."""
    sentence = _objection(context.object)
    if sentence:
        operator.poll_message_set(sentence)
    return not sentence


def _objection(obj: bpy.types.Object | None) -> str:
    if not is_engine_complete():
        return MISSING_SCIPY
    if obj is None or obj.type != "MESH":
        return "Select a mesh object first."
    # Another object with the same mesh may be the one in edit mode.
    mesh = mesh_of(obj)
    if mesh.is_editmode:
        return IN_EDIT_MODE
    return LINKED if is_linked(mesh) else ""


def is_linked(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh lies in another file, or overrides one there: what is written to such a mesh is not saved."""
    return mesh.library is not None or mesh.override_library is not None
