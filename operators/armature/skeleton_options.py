"""Options of a skeleton; the scene keeps them for the panel, the operators take them from scripts."""

import bpy
from bpy.props import PointerProperty

from ..blender.registered_settings import SKELETON_SETTINGS
from ..blender.typed_properties import EnumProperty, IntProperty, TypedProperties


class SkeletonOptions(TypedProperties):
    """Options of all operators that lay bones."""

    bones_in_limbs: int = IntProperty(
        name="Bones in Limbs",
        description="How many bones a long straight limb is divided into, so that it can be bent",
        default=2,
        min=1,
        max=8,
    )


class ArmatureOptions(SkeletonOptions, TypedProperties):
    """Options of an armature."""

    weights: str = EnumProperty(
        name="Weights",
        description="How the bones move the mesh",
        items=[
            ("PARTS", "From Parts", "Each bone moves its part, with soft borders at the joints"),
            ("AUTOMATIC", "Automatic", "Blender's own automatic weights"),
            ("NONE", "None", "The armature is made, but the mesh is not bound to it"),
        ],
    )


class EigenpartsSkeletonSettings(ArmatureOptions, bpy.types.PropertyGroup):
    """The options the panel shows."""


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsSkeletonSettings,))


def register() -> None:
    """Give scenes their settings."""
    _register_classes()
    setattr(bpy.types.Scene, SKELETON_SETTINGS, PointerProperty(type=EigenpartsSkeletonSettings))


def unregister() -> None:
    """Take the settings away again."""
    delattr(bpy.types.Scene, SKELETON_SETTINGS)
    _unregister_classes()
