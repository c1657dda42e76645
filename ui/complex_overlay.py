"""Draw the traced complexes over the view, through the bodies that hide half of each."""

from collections.abc import Iterator

import bpy
import gpu
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector

from ..operators.palette import COMPLEX_COLOURS, COMPLEX_ROLE

# Pixels, at a scale of the interface of 1.
LINE_WIDTH, DOT_RADIUS, DOT_CORNERS = 2.0, 6.0, 20
# What lies behind the surface is drawn too, but fainter.
BEHIND = 0.3

_handler: object | None = None


def draw() -> None:
    """Draw all traced complexes of the view."""
    region_3d = bpy.context.region_data
    if region_3d is None or not bpy.context.space_data.overlay.show_overlays:
        return
    lines = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    dots = gpu.shader.from_builtin("UNIFORM_COLOR")
    gpu.state.blend_set("ALPHA")
    for depth_test, opacity in (("GREATER", BEHIND), ("LESS_EQUAL", 1.0)):
        gpu.state.depth_test_set(depth_test)
        for obj in traced_objects(bpy.context):
            role = obj[COMPLEX_ROLE]
            colour = (*display_colour(COMPLEX_COLOURS[role]), opacity)
            if obj.type == "CURVE":
                _draw_lines(lines, obj, colour)
            else:
                _draw_dots(dots, obj, colour, region_3d)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def traced_objects(context: bpy.types.Context) -> Iterator[bpy.types.Object]:
    """Yield the objects of traced complexes that can be seen."""
    return (obj for obj in context.view_layer.objects if obj.get(COMPLEX_ROLE) in COMPLEX_COLOURS and obj.visible_get())


def places_of_dots(obj: bpy.types.Object) -> list[Vector]:
    """Return where the critical points of an object lie in the world; the object keeps them for this."""
    flat = list(obj.get("places", ()))
    return [obj.matrix_world @ Vector(flat[k : k + 3]) for k in range(0, len(flat), 3)]


def disk_facing_the_view(centre: Vector, view: Matrix, radius: float) -> list[Vector]:
    """Return the corners of triangles that make up a disk, turned to the viewer."""
    across, up = (view.inverted().col[k].xyz * radius for k in (0, 1))
    turn = Matrix.Rotation(6.283185307179586 / DOT_CORNERS, 2)
    spoke, corners = Vector((1, 0)), []
    for _ in range(DOT_CORNERS):
        following = turn @ spoke
        corners += [centre, *(centre + s.x * across + s.y * up for s in (spoke, following))]
        spoke = following
    return corners


def display_colour(linear: tuple[float, ...]) -> tuple[float, ...]:
    """Return sRGB components, which the overlay is drawn in."""
    return tuple(12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear)


def _draw_lines(shader: gpu.types.GPUShader, obj: bpy.types.Object, colour: tuple[float, ...]) -> None:
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", LINE_WIDTH * bpy.context.preferences.system.ui_scale)
    shader.uniform_float("color", colour)
    for spline in obj.data.splines:
        places = [obj.matrix_world @ point.co.xyz for point in spline.points]
        batch_for_shader(shader, "LINE_STRIP", {"pos": places}).draw(shader)


def _draw_dots(
    shader: gpu.types.GPUShader, obj: bpy.types.Object, colour: tuple[float, ...], region_3d: bpy.types.RegionView3D
) -> None:
    corners = []
    pixels = DOT_RADIUS * bpy.context.preferences.system.ui_scale
    for centre in places_of_dots(obj):
        # How much of the world a pixel covers at this depth.
        depth = (region_3d.perspective_matrix @ centre.to_4d()).w
        radius = pixels * 2 * depth / (region_3d.window_matrix[0][0] * bpy.context.region.width)
        corners += disk_facing_the_view(centre, region_3d.view_matrix, radius)
    shader.uniform_float("color", colour)
    batch_for_shader(shader, "TRIS", {"pos": corners}).draw(shader)


class EIGENPARTS_PT_topology(bpy.types.Panel):
    bl_label = "Topology"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenparts"
    bl_order = 60
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column()
        column.operator("eigenparts.plot_diagram", icon="IMAGE_DATA")
        column.operator("eigenparts.trace_complex", icon="OUTLINER_OB_CURVE")
        column.prop(context.window_manager, "eigenparts_complex_through", icon="XRAY")


def _toggle(window_manager: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    _remove_handler()
    if window_manager.eigenparts_complex_through:
        _add_handler()
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D":
            area.tag_redraw()


def _add_handler() -> None:
    global _handler
    _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")


def _remove_handler() -> None:
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
    _handler = None


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EIGENPARTS_PT_topology,))


def register() -> None:
    """Add the panel and the switch."""
    _register_classes()
    bpy.types.WindowManager.eigenparts_complex_through = bpy.props.BoolProperty(
        name="Show Complex Through",
        description="Draw traced complexes over the view, also where they are behind the surface",
        update=_toggle,
        options={"SKIP_SAVE"},
    )


def unregister() -> None:
    """Take the switch and what it draws away again."""
    _remove_handler()
    del bpy.types.WindowManager.eigenparts_complex_through
    _unregister_classes()
