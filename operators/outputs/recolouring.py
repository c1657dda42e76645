"""Show the colours that the user prefers on all meshes that have parts, as soon as they change."""

from contextlib import suppress

import bpy
from bpy.app.handlers import persistent

from ...tasks.refusals import Refusal
from ..mesh_state.state import is_analyzed
from ..messages.user_errors import is_linked
from . import part_writer

_is_changed = False


def show_changed_colours() -> None:
    """Recolour what is divided, now and whenever undo brings meshes back that were coloured before."""
    global _is_changed
    _is_changed = True
    recolour_meshes()


def recolour_meshes() -> None:
    """Give the parts of all meshes the colours they have by now; what cannot be written to keeps its own."""
    for mesh in bpy.data.meshes:
        if is_analyzed(mesh) and not mesh.is_editmode and not is_linked(mesh):
            with suppress(Refusal):
                part_writer.recolour(mesh)


# The stubs give it no types.
@persistent  # type: ignore[untyped-decorator]
def _follow_undo(*_: object) -> None:
    if _is_changed:
        recolour_meshes()


def register() -> None:
    """Begin to listen to undo and redo."""
    bpy.app.handlers.undo_post.append(_follow_undo)
    bpy.app.handlers.redo_post.append(_follow_undo)


def unregister() -> None:
    """Listen no more."""
    global _is_changed
    _is_changed = False
    bpy.app.handlers.undo_post.remove(_follow_undo)
    bpy.app.handlers.redo_post.remove(_follow_undo)
