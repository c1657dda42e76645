"""Blender properties that are declared like the values they hold: ``level: int = IntProperty(name="Level")``.

Blender reads properties from annotations, where a type checker expects types. So they are declared as values, and put
among the annotations when the class is made.
"""

from collections.abc import Callable
from typing import Any, ParamSpec

import bpy

Options = ParamSpec("Options")


class TypedProperties:
    """Base class of the classes that declare properties, to be named before Blender's own."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        for name, value in list(vars(cls).items()):
            if isinstance(value, bpy.props._PropertyDeferred):
                cls.__annotations__[name] = value
                delattr(cls, name)


def _with_any_type(declare: Callable[Options, object]) -> Callable[Options, Any]:
    """Return Blender's function as one whose result may stand for a value of any type."""
    return declare


BoolProperty = _with_any_type(bpy.props.BoolProperty)
CollectionProperty = _with_any_type(bpy.props.CollectionProperty)
EnumProperty = _with_any_type(bpy.props.EnumProperty)
FloatProperty = _with_any_type(bpy.props.FloatProperty)
FloatVectorProperty = _with_any_type(bpy.props.FloatVectorProperty)
IntProperty = _with_any_type(bpy.props.IntProperty)
PointerProperty = _with_any_type(bpy.props.PointerProperty)
StringProperty = _with_any_type(bpy.props.StringProperty)
