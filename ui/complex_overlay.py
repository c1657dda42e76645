"""Draw the borders of parts and traced complexes over the view, and say which of them are to be seen."""

from collections.abc import Callable, Iterator

import bpy
import gpu
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector

from ..operators.mesh_state.palette import BORDER_COLOUR, COMPLEX_COLOURS, COMPLEX_ROLE
from ..operators.parts.border_lines import border_lines

# Pixels, at a scale of the interface of 1.
LINE_WIDTH, BORDER_WIDTH, DOT_RADIUS, DOT_CORNERS = 2.0, 2.5, 6.0, 20
# What lies behind the surface is drawn too, but fainter.
BEHIND = 0.3
# Lines lie on faces; so much of the depth of the view they are drawn in front of them.
NEARER = 2e-5
# What can be shown and hidden of a traced complex, and what it is called.
SHOWN = {
    "critical_points": ("Critical Points", "Dots at minima, saddles and maxima", ("minimum", "saddle", "maximum")),
    "separatrices": ("Separatrices", "Lines of steepest ascent from saddles", ("rising", "falling")),
    "level_sets": ("Level Sets", "Lines of equal value through saddles", ("level",)),
}

_handler: object | None = None


def draw() -> None:
    """Draw what the switches ask for."""
    region_3d, switches = bpy.context.region_data, bpy.context.window_manager
    if region_3d is None or not bpy.context.space_data.overlay.show_overlays:
        return
    if not (switches.eigenparts_borders or switches.eigenparts_complex_through):
        return
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop_projection():
        gpu.matrix.load_projection_matrix(_nearer(gpu.matrix.get_projection_matrix()))
        if switches.eigenparts_borders:
            _draw_borders()
        if switches.eigenparts_complex_through:
            _draw_complexes(region_3d)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def traced_objects(context: bpy.types.Context) -> Iterator[bpy.types.Object]:
    """Yield the objects of traced complexes that can be seen."""
    return (obj for obj in _objects_of_roles(context, COMPLEX_COLOURS) if obj.visible_get())


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


def _nearer(projection: Matrix) -> Matrix:
    """Return a projection that draws everything a little in front of where it is."""
    nearer = projection.copy()
    nearer[2] = nearer[2] - NEARER * nearer[3]
    return nearer


def _draw_borders() -> None:
    shader = _line_shader((*display_colour(BORDER_COLOUR), 1.0), BORDER_WIDTH)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    gpu.state.depth_test_set("LESS_EQUAL")
    for obj in bpy.context.visible_objects:
        lines = border_lines(obj, depsgraph)
        if len(lines):
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(obj.matrix_world)
                batch_for_shader(shader, "LINES", {"pos": lines}).draw(shader)


def _draw_complexes(region_3d: bpy.types.RegionView3D) -> None:
    for depth_test, opacity in (("GREATER", BEHIND), ("LESS_EQUAL", 1.0)):
        gpu.state.depth_test_set(depth_test)
        for obj in traced_objects(bpy.context):
            colour = (*display_colour(COMPLEX_COLOURS[obj[COMPLEX_ROLE]]), opacity)
            if obj.type == "CURVE":
                _draw_lines(obj, colour)
            else:
                _draw_dots(obj, colour, region_3d)


def _draw_lines(obj: bpy.types.Object, colour: tuple[float, ...]) -> None:
    shader = _line_shader(colour, LINE_WIDTH)
    for spline in obj.data.splines:
        places = [obj.matrix_world @ point.co.xyz for point in spline.points]
        batch_for_shader(shader, "LINE_STRIP", {"pos": places}).draw(shader)


def _line_shader(colour: tuple[float, ...], width: float) -> gpu.types.GPUShader:
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width * bpy.context.preferences.system.ui_scale)
    shader.uniform_float("color", colour)
    return shader


def _draw_dots(obj: bpy.types.Object, colour: tuple[float, ...], region_3d: bpy.types.RegionView3D) -> None:
    corners = []
    pixels = DOT_RADIUS * bpy.context.preferences.system.ui_scale
    for centre in places_of_dots(obj):
        # How much of the world a pixel covers at this depth.
        depth = (region_3d.perspective_matrix @ centre.to_4d()).w
        radius = pixels * 2 * depth / (region_3d.window_matrix[0][0] * bpy.context.region.width)
        corners += disk_facing_the_view(centre, region_3d.view_matrix, radius)
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
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
        switches = context.window_manager
        column = self.layout.column(heading="Show")
        column.prop(switches, "eigenparts_borders")
        traced = column.column()
        traced.active = any(_objects_of_roles(context, COMPLEX_COLOURS))
        for name in SHOWN:
            traced.prop(switches, f"eigenparts_{name}")
        traced.prop(switches, "eigenparts_complex_through")
        column = self.layout.column()
        column.operator("eigenparts.trace_complex", icon="OUTLINER_OB_CURVE")
        column.operator("eigenparts.plot_diagram", icon="IMAGE_DATA")


def _objects_of_roles(context: bpy.types.Context, roles: object) -> Iterator[bpy.types.Object]:
    return (obj for obj in context.view_layer.objects if obj.get(COMPLEX_ROLE) in roles)


def _redraw(window_manager: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D":
            area.tag_redraw()


def _is_any_shown(roles: tuple[str, ...]) -> Callable[[bpy.types.WindowManager], bool]:
    return lambda _: any(not obj.hide_get() for obj in _objects_of_roles(bpy.context, roles))


def _show_all(roles: tuple[str, ...]) -> Callable[[bpy.types.WindowManager, bool], None]:
    def show(_: bpy.types.WindowManager, wanted: bool) -> None:
        for obj in _objects_of_roles(bpy.context, roles):
            obj.hide_set(not wanted)

    return show


def _switches() -> dict[str, object]:
    """Return the properties of the window manager by name."""
    complexes = {
        f"eigenparts_{name}": bpy.props.BoolProperty(
            name=label, description=f"{text}; Trace Complex makes them", get=_is_any_shown(roles), set=_show_all(roles)
        )
        for name, (label, text, roles) in SHOWN.items()
    }
    return complexes | {
        "eigenparts_borders": bpy.props.BoolProperty(
            name="Borders", description="Draw the borders between parts", update=_redraw, options={"SKIP_SAVE"}
        ),
        "eigenparts_complex_through": bpy.props.BoolProperty(
            name="Show Through",
            description="Draw traced complexes over the view, also where they are behind the surface",
            update=_redraw,
            options={"SKIP_SAVE"},
        ),
    }


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EIGENPARTS_PT_topology,))


def register() -> None:
    """Add the panel, the switches and what draws."""
    global _handler
    _register_classes()
    for name, switch in _switches().items():
        setattr(bpy.types.WindowManager, name, switch)
    _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    """Take them away again."""
    bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
    for name in _switches():
        delattr(bpy.types.WindowManager, name)
    _unregister_classes()
