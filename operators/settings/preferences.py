"""Preferences of the user in all files: the colours of parts, and how many cores and processes may work."""

from typing import Any, cast

import bpy

from ..blender.known_values import present
from ..blender.outcome import Outcome
from ..blender.typed_properties import FloatVectorProperty, IntProperty, TypedProperties
from ..jobs.user_preferences import PACKAGE, user_preferences
from ..mesh_state import palette
from ..outputs import recolouring

COLOURS = tuple(f"color_{number}" for number in range(1, len(palette.PARTS) + 1))
COLUMNS = 7


def _colour(name: str, description: str, default: tuple[float, ...]) -> Any:
    return FloatVectorProperty(
        name=name, description=description, subtype="COLOR", size=3, min=0, max=1, default=default, update=_show_colours
    )


def _take_colours(preferences: "EigenpartsPreferences") -> None:
    palette.use_colours([tuple(getattr(preferences, name)) for name in ("body", *COLOURS)])


def _show_colours(preferences: "EigenpartsPreferences", context: bpy.types.Context) -> None:
    _take_colours(preferences)
    recolouring.show_changed_colours()


class EigenpartsPreferences(TypedProperties, bpy.types.AddonPreferences):
    bl_idname = PACKAGE

    n_threads: int = IntProperty(
        name="Threads",
        description="Processor cores that an analysis may use; 0 leaves it to the libraries",
        default=0,
        min=0,
        soft_max=64,
    )
    n_processes: int = IntProperty(
        name="Processes",
        description="In how many processes several meshes are analyzed and matched side by side; 0 for as many as half"
        " of the processor cores, but no more than the memory allows",
        default=0,
        min=0,
        soft_max=16,
    )
    body: tuple[float, float, float] = _colour(
        "Body", "Color of what belongs to no part", palette.standard_colours()[0]
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        layout.use_property_split = True
        layout.prop(self, "n_threads")
        layout.prop(self, "n_processes")
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


def _preferences() -> EigenpartsPreferences | None:
    return cast(EigenpartsPreferences | None, user_preferences())


class EIGENPARTS_OT_reset_colors(bpy.types.Operator):
    """Go back to the colors that color-blind people can tell apart too"""

    bl_idname = "eigenparts.reset_colors"
    bl_label = "Reset Colors"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> Outcome:
        preferences = _preferences()
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
    preferences = _preferences()
    if preferences is not None:
        _take_colours(preferences)


def unregister() -> None:
    """Remove the preferences."""
    _unregister_classes()
    palette.use_colours(palette.standard_colours())
