"""The outline of the part that was clicked in the list, drawn over the view, so that a click shows in object mode."""

import bpy
import gpu

from ..operators.parts.part_outline import outline
from .overlay_drawing import draw_lines, in_space_of, line_shader, shows_overlays
from .overlay_switches import OUTLINE, is_on

# Pixels, at a scale of the interface of 1, and sRGB; what lies behind the surface is fainter.
WIDTH, COLOUR = 4.0, (1.0, 1.0, 1.0)
BEHIND = 0.35

_handler: object | None = None


def draw() -> None:
    """Draw the outline of the active part of the active object."""
    obj = bpy.context.object
    if not shows_overlays(bpy.context) or not is_on(OUTLINE) or obj is None or not obj.visible_get():
        return
    lines = outline(obj, bpy.context.evaluated_depsgraph_get())
    if not len(lines):
        return
    gpu.state.blend_set("ALPHA")
    with in_space_of(obj):
        gpu.state.depth_test_set("NONE")
        draw_lines(line_shader((*COLOUR, BEHIND), WIDTH), lines)
        gpu.state.depth_test_set("LESS_EQUAL")
        draw_lines(line_shader((*COLOUR, 1.0), WIDTH), lines)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def register() -> None:
    """Start drawing, where there is a window."""
    global _handler
    if not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    """Stop drawing."""
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None
