"""Switches of the window manager: what is drawn over the view, and which objects of traced complexes are shown."""

from collections.abc import Callable, Mapping

import bpy
from bpy.props import BoolProperty

from .traced_objects import objects_of_roles

BORDERS = "eigenparts_borders"
SHOW_THROUGH = "eigenparts_complex_through"
OUTLINE = "eigenparts_outline"
# What can be shown and hidden of a traced complex: its name, its description and its roles.
SHOWN = {
    "critical_points": ("Critical Points", "Dots at minima, saddles and maxima", ("minimum", "saddle", "maximum")),
    "separatrices": ("Separatrices", "Lines of steepest ascent from saddles", ("rising", "falling")),
    "level_sets": ("Level Sets", "Lines of equal value through saddles", ("level",)),
}


def is_on(switch: str) -> bool:
    """Whether the user has switched something on."""
    return bool(getattr(bpy.context.window_manager, switch))


def _redraw(_: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D":
            area.tag_redraw()


def _is_any_shown(roles: tuple[str, ...]) -> Callable[[bpy.types.WindowManager], bool]:
    return lambda _: any(not obj.hide_get() for obj in objects_of_roles(bpy.context, roles))


def _show_all(roles: tuple[str, ...]) -> Callable[[bpy.types.WindowManager, bool], None]:
    def show(_: bpy.types.WindowManager, wanted: bool) -> None:
        for obj in objects_of_roles(bpy.context, roles):
            obj.hide_set(not wanted)

    return show


def _switches() -> Mapping[str, object]:
    """Return the properties of the window manager by name."""
    complexes = {
        f"eigenparts_{name}": BoolProperty(
            name=label, description=f"{text}; Trace Complex makes them", get=_is_any_shown(roles), set=_show_all(roles)
        )
        for name, (label, text, roles) in SHOWN.items()
    }
    return complexes | {
        BORDERS: BoolProperty(
            name="Borders", description="Draw the borders between parts", update=_redraw, options={"SKIP_SAVE"}
        ),
        SHOW_THROUGH: BoolProperty(
            name="Show Through",
            description="Draw traced complexes over the view, also where they are behind the surface",
            update=_redraw,
            options={"SKIP_SAVE"},
        ),
        OUTLINE: BoolProperty(
            name="Outline Active Part",
            description="Draw a line around the part that was clicked in the list",
            default=True,
            options={"SKIP_SAVE"},
        ),
    }


def register() -> None:
    """Give the window manager the switches."""
    for name, switch in _switches().items():
        setattr(bpy.types.WindowManager, name, switch)


def unregister() -> None:
    """Take them away again."""
    for name in _switches():
        delattr(bpy.types.WindowManager, name)
