"""The 3D views: solid mode shows the active colours and gets back what the user had; overlays are drawn anew."""

from collections.abc import Iterator

import bpy

from ..blender.known_values import present

# On the screen: the colour type that each area had, by its place among the areas.
PREVIOUS_TYPES = "eigenparts_color_types"


def show_vertex_colours(context: bpy.types.Context) -> None:
    """Make every visible 3D view show the active colour attribute in solid mode."""
    for screen, place, shading in _shadings(context):
        if shading.color_type != "VERTEX":
            previous = dict(screen.get(PREVIOUS_TYPES, {}))
            screen[PREVIOUS_TYPES] = previous | {str(place): shading.color_type}
            shading.color_type = "VERTEX"


def restore_colour_types(context: bpy.types.Context) -> None:
    """Give the 3D views the colour type they had before."""
    for screen, place, shading in _shadings(context):
        previous = dict(screen.get(PREVIOUS_TYPES, {})).get(str(place))
        if previous is not None and shading.color_type == "VERTEX":
            shading.color_type = previous
    for window in present(context.window_manager).windows:
        if window.screen.get(PREVIOUS_TYPES) is not None:
            del window.screen[PREVIOUS_TYPES]


def redraw_views(context: bpy.types.Context) -> None:
    """Draw every visible 3D view again, where an overlay shows what Blender does not know of."""
    for window in present(context.window_manager).windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _shadings(context: bpy.types.Context) -> Iterator[tuple[bpy.types.Screen, int, bpy.types.View3DShading]]:
    for window in present(context.window_manager).windows:
        for place, area in enumerate(window.screen.areas):
            space = area.spaces.active
            if isinstance(space, bpy.types.SpaceView3D):
                yield window.screen, place, space.shading
