"""The points that the user gave, drawn over the view as numbered dots."""

from collections.abc import Iterator

import blf
import bpy
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Matrix, Vector

from ..operators.mesh_state.point_pairs import PointEnd, numbered_pairs, shown_place
from .overlay_drawing import disk_facing_the_view, draw_triangles, in_pixels, shows_overlays

# Pixels at a scale of the interface of 1, and sRGB.
RADIUS, RIM, LETTERS = 9.0, 1.5, 11.0
COLOUR, RIM_COLOUR, LETTER_COLOUR = (0.95, 0.55, 0.1, 1.0), (0.1, 0.1, 0.1, 1.0), (0.05, 0.05, 0.05, 1.0)

_handler: object | None = None


def draw() -> None:
    """Draw a dot with its number for each point of the objects that can be seen."""
    context = bpy.context
    if not shows_overlays(context):
        return
    gpu.state.blend_set("ALPHA")
    for place, number in _dots(context):
        _draw_dot(place, str(number))
    gpu.state.blend_set("NONE")


def _dots(context: bpy.types.Context) -> Iterator[tuple[Vector, int]]:
    """Yield the place of each dot in the region, and its number."""
    region = context.region
    if region is None or not isinstance(region.data, bpy.types.RegionView3D):
        return
    depsgraph = context.evaluated_depsgraph_get()
    for number, ends in numbered_pairs(context):
        for end in ends:
            place = _place_in_region(region, end, depsgraph)
            if place is not None:
                yield place, number


def _place_in_region(region: bpy.types.Region, end: PointEnd, depsgraph: bpy.types.Depsgraph) -> Vector | None:
    if not end.is_there or not end.obj.visible_get():
        return None
    assert isinstance(region.data, bpy.types.RegionView3D)
    place = end.obj.matrix_world @ shown_place(end, depsgraph)
    return location_3d_to_region_2d(region, region.data, place)


def _draw_dot(place: Vector, text: str) -> None:
    for colour, radius in ((RIM_COLOUR, RADIUS + RIM), (COLOUR, RADIUS)):
        draw_triangles(colour, disk_facing_the_view(place.to_3d(), Matrix.Identity(4), in_pixels(radius)))
    blf.size(0, in_pixels(LETTERS))
    blf.color(0, *LETTER_COLOUR)
    width, height = blf.dimensions(0, text)
    blf.position(0, place.x - width / 2, place.y - height / 2, 0)
    blf.draw(0, text)


def register() -> None:
    """Start drawing, where there is a window."""
    global _handler
    if not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_PIXEL")


def unregister() -> None:
    """Stop drawing."""
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None
