"""Options of a skeleton; the scene keeps them for the panel, the operators take them from scripts."""

import bpy
from bpy.props import EnumProperty, IntProperty, PointerProperty


class SkeletonOptions:
    """Options of all operators that lay bones."""

    bones_in_limbs: IntProperty(
        name="Bones in Limbs",
        description="How many bones a long straight limb is divided into, so that it can be bent",
        default=2,
        min=1,
        max=8,
    )


class ArmatureOptions(SkeletonOptions):
    """Options of an armature."""

    weights: EnumProperty(
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
    bpy.types.Scene.eigenparts_skeleton = PointerProperty(type=EigenpartsSkeletonSettings)


def unregister() -> None:
    """Take the settings away again."""
    del bpy.types.Scene.eigenparts_skeleton
    _unregister_classes()
