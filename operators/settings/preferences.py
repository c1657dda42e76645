"""Preferences of the user in all files: the colours of parts, and how many cores an analysis may take."""

import bpy
from bpy.props import FloatVectorProperty, IntProperty

from ..jobs.threads import PACKAGE, user_preferences
from ..mesh_state import palette
from ..outputs import recolouring

COLOURS = tuple(f"color_{number}" for number in range(1, len(palette.PARTS) + 1))
COLUMNS = 7


def _colour(name: str, description: str, default: tuple[float, ...]) -> object:
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", size=3, min=0, max=1, default=default, update=_show_colours
    )


def _take_colours(preferences: "EigenpartsPreferences") -> None:
    palette.use_colours([tuple(getattr(preferences, name)) for name in ("body", *COLOURS)])


def _show_colours(preferences: "EigenpartsPreferences", context: bpy.types.Context) -> None:
    _take_colours(preferences)
    recolouring.show_changed_colours()


class EigenpartsPreferences(bpy.types.AddonPreferences):
    bl_idname = PACKAGE

    n_threads: IntProperty(
        name="Threads",
        description="Processor cores that an analysis may use; 0 leaves it to the libraries",
        default=0,
        min=0,
        soft_max=64,
    )
    body: _colour("Body", "Color of what belongs to no part", palette.standard_colours()[0])

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "n_threads")
        layout.label(text="Colors of parts, for those that have no color of their own")
        grid = layout.grid_flow(row_major=True, columns=COLUMNS, even_columns=True, align=True)
        grid.use_property_split = False
        for name in ("body", *COLOURS):
            grid.prop(self, name, text="")
        layout.operator("eigenparts.reset_colors", icon="LOOP_BACK")


# The palette decides how many there are.
EigenpartsPreferences.__annotations__ |= {
    name: _colour("Part", "Color of a part; after the last, the colors repeat", colour)
    for name, colour in zip(COLOURS, palette.standard_colours()[1:], strict=True)
}


class EIGENPARTS_OT_reset_colors(bpy.types.Operator):
    """Go back to the colors that color-blind people can tell apart too"""

    bl_idname = "eigenparts.reset_colors"
    bl_label = "Reset Colors"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        preferences = user_preferences()
        if preferences is not None:
            for name in ("body", *COLOURS):
                preferences.property_unset(name)
            _show_colours(preferences, context)
        return {"FINISHED"}


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (EIGENPARTS_OT_reset_colors, EigenpartsPreferences)
)


def register() -> None:
    """Add the preferences, and take the colours from them."""
    _register_classes()
    preferences = user_preferences()
    if preferences is not None:
        _take_colours(preferences)


def unregister() -> None:
    """Remove the preferences."""
    _unregister_classes()
    palette.use_colours(palette.standard_colours())
