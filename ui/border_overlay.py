"""The borders between parts, drawn over the view."""

import bpy
import gpu

from ..operators.mesh_state.palette import BORDER_COLOUR
from ..operators.parts.border_lines import border_lines
from .overlay_drawing import display_colour, draw_lines, drawing_over_faces, in_space_of, line_shader, shows_overlays
from .overlay_switches import BORDERS, is_on

# Pixels, at a scale of the interface of 1.
WIDTH = 2.5

_handler: object | None = None


def draw() -> None:
    """Draw the borders of all objects that can be seen, if they are switched on."""
    if shows_overlays(bpy.context) and is_on(BORDERS):
        with drawing_over_faces():
            _draw_borders()


def _draw_borders() -> None:
    shader = line_shader((*display_colour(BORDER_COLOUR), 1.0), WIDTH)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    gpu.state.depth_test_set("LESS_EQUAL")
    for obj in bpy.context.visible_objects:
        lines = border_lines(obj, depsgraph)
        if len(lines):
            with in_space_of(obj):
                draw_lines(shader, lines)


def register() -> None:
    """Start drawing."""
    global _handler
    _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    """Stop drawing."""
    bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
