"""Draw the outline of the part that was clicked in the list, so that a click shows something in object mode too."""

import bpy
import gpu
from gpu_extras.batch import batch_for_shader

from ..operators.parts.part_outline import outline

# Pixels, at a scale of the interface of 1, and sRGB; what lies behind the surface is fainter.
WIDTH, COLOUR = 4.0, (1.0, 1.0, 1.0)
BEHIND = 0.35

_handler: object | None = None


def draw() -> None:
    """Draw the outline of the active part of the active object."""
    context = bpy.context
    if not context.space_data.overlay.show_overlays or not context.window_manager.eigenparts_outline:
        return
    obj = context.object
    if obj is None or not obj.visible_get():
        return
    lines = outline(obj, context.evaluated_depsgraph_get())
    if not len(lines):
        return
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(obj.matrix_world)
        for depth_test, opacity in (("NONE", BEHIND), ("LESS_EQUAL", 1.0)):
            gpu.state.depth_test_set(depth_test)
            shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
            shader.uniform_float("lineWidth", WIDTH * context.preferences.system.ui_scale)
            shader.uniform_float("color", (*COLOUR, opacity))
            batch_for_shader(shader, "LINES", {"pos": lines}).draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def register() -> None:
    """Add the switch and start drawing."""
    global _handler
    bpy.types.WindowManager.eigenparts_outline = bpy.props.BoolProperty(
        name="Outline Active Part",
        description="Draw a line around the part that was clicked in the list",
        default=True,
        options={"SKIP_SAVE"},
    )
    if not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    """Stop drawing and take the switch away."""
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None
    del bpy.types.WindowManager.eigenparts_outline
