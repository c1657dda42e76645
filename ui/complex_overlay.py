"""Traced complexes, drawn over the view: lines and dots, fainter where they are behind the surface."""

import bpy
import gpu
from mathutils import Vector

from ..operators.blender.known_values import data_of, present
from ..operators.mesh_state.palette import COMPLEX_COLOURS, COMPLEX_ROLE
from .overlay_drawing import (
    Colour,
    disk_facing_the_view,
    display_colour,
    draw_line_strip,
    draw_triangles,
    drawing_over_faces,
    in_pixels,
    line_shader,
    shows_overlays,
)
from .overlay_switches import SHOW_THROUGH, is_on
from .traced_objects import critical_points_of, traced_objects

# Pixels, at a scale of the interface of 1.
LINE_WIDTH, DOT_RADIUS = 2.0, 6.0
# Opacity of what lies behind the surface.
BEHIND = 0.3

_handler: object | None = None


def draw() -> None:
    """Draw the traced complexes that can be seen, if they are to show through."""
    region_3d = bpy.context.region_data
    if region_3d is not None and shows_overlays(bpy.context) and is_on(SHOW_THROUGH):
        with drawing_over_faces():
            _draw_complexes(region_3d)


def _draw_complexes(region_3d: bpy.types.RegionView3D) -> None:
    gpu.state.depth_test_set("GREATER")
    _draw_objects(region_3d, BEHIND)
    gpu.state.depth_test_set("LESS_EQUAL")
    _draw_objects(region_3d, 1.0)


def _draw_objects(region_3d: bpy.types.RegionView3D, opacity: float) -> None:
    for obj in traced_objects(bpy.context):
        colour = (*display_colour(COMPLEX_COLOURS[obj[COMPLEX_ROLE]]), opacity)
        if obj.type == "CURVE":
            _draw_lines(obj, colour)
        else:
            _draw_dots(obj, colour, region_3d)


def _draw_lines(obj: bpy.types.Object, colour: Colour) -> None:
    shader = line_shader(colour, LINE_WIDTH)
    for spline in data_of(obj, bpy.types.Curve).splines:
        points = [obj.matrix_world @ point.co.xyz for point in spline.points]
        draw_line_strip(shader, points)


def _draw_dots(obj: bpy.types.Object, colour: Colour, region_3d: bpy.types.RegionView3D) -> None:
    corners: list[Vector] = []
    width_of_view = present(bpy.context.region).width
    for centre in critical_points_of(obj):
        # How much of the world a pixel covers at this depth.
        depth = (region_3d.perspective_matrix @ centre.to_4d()).w
        radius = in_pixels(DOT_RADIUS) * 2 * depth / (region_3d.window_matrix[0][0] * width_of_view)
        corners += disk_facing_the_view(centre, region_3d.view_matrix, radius)
    draw_triangles(colour, corners)


def register() -> None:
    """Start drawing."""
    global _handler
    _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")


def unregister() -> None:
    """Stop drawing."""
    bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
