"""The list of the pairs of points that were given in a scene."""

import bpy
from bpy.props import CollectionProperty

from ..blender.registered_settings import POINT_PAIRS
from ..blender.typed_properties import IntProperty, PointerProperty, TypedProperties


class EigenpartsPointPair(TypedProperties, bpy.types.PropertyGroup):
    """A vertex of one object and the vertex of another that it belongs to."""

    source: bpy.types.Object | None = PointerProperty(
        type=bpy.types.Object, name="Object", description="Where one of the two points is"
    )
    source_vertex: int = IntProperty(name="Vertex", description="Number of its vertex")
    n_source: int = IntProperty(name="Vertices", description="How many the mesh had when the point was given")
    target: bpy.types.Object | None = PointerProperty(
        type=bpy.types.Object, name="Other Object", description="Where the other one is"
    )
    target_vertex: int = IntProperty(name="Vertex", description="Number of its vertex")
    n_target: int = IntProperty(name="Vertices", description="How many the mesh had when the point was given")


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsPointPair,))


def register() -> None:
    """Give scenes the list."""
    _register_classes()
    setattr(bpy.types.Scene, POINT_PAIRS, CollectionProperty(type=EigenpartsPointPair))


def unregister() -> None:
    """Take it away again."""
    delattr(bpy.types.Scene, POINT_PAIRS)
    _unregister_classes()
