"""Options of an analysis, in the panel and in scripts."""

import bpy
from bpy.props import PointerProperty

from ..blender.registered_settings import SETTINGS
from ..blender.typed_properties import BoolProperty, EnumProperty, IntProperty, StringProperty, TypedProperties
from .choice_items import BORDER_ITEMS, BOUNDARY_ITEMS, FIELD_ITEMS, ORDER_ITEMS, SHELL_ITEMS


class AnalysisOptions(TypedProperties):
    """Options of an analysis; the scene keeps them for the panel, the operator takes them from scripts."""

    field: str = EnumProperty(
        name="Field",
        description="The function on the surface whose hills become parts",
        items=FIELD_ITEMS,
    )
    eigenfunction: int = IntProperty(
        name="Number", description="Which eigenfunction, counted from the smoothest", default=1, min=1
    )
    attribute: str = StringProperty(
        name="Attribute", description="Name of the attribute that has your values, one decimal number for each vertex"
    )
    order: str = EnumProperty(
        name="Order",
        description="Degree of the finite elements: higher is more accurate and slower",
        items=ORDER_ITEMS,
    )
    boundary: str = EnumProperty(
        name="Boundary",
        description="How the function behaves at open edges",
        items=BOUNDARY_ITEMS,
    )
    shells: str = EnumProperty(
        name="Loose Parts",
        description="What is done with a mesh of several loose parts",
        items=SHELL_ITEMS,
    )
    borders: str = EnumProperty(
        name="Borders",
        description="Where parts end on whole faces",
        items=BORDER_ITEMS,
    )
    use_modifiers: bool = BoolProperty(
        name="With Modifiers",
        description="Analyze the posed shape as modifiers leave it; they must not change the faces",
    )


class EigenpartsAnalysisSettings(AnalysisOptions, bpy.types.PropertyGroup):
    """The options the panel shows."""


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsAnalysisSettings,))


def register() -> None:
    """Give scenes the options."""
    _register_classes()
    setattr(bpy.types.Scene, SETTINGS, PointerProperty(type=EigenpartsAnalysisSettings))


def unregister() -> None:
    """Take them away again."""
    delattr(bpy.types.Scene, SETTINGS)
    _unregister_classes()
