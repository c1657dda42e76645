"""Options of a transfer, in the panel and in scripts."""

import bpy
from bpy.props import PointerProperty

from ..blender.registered_settings import TRANSFER_SETTINGS
from ..blender.typed_properties import BoolProperty, EnumProperty, FloatProperty, StringProperty, TypedProperties
from .layer_choices import DEFAULT_LAYERS, LAYERS


class TransferOptions(TypedProperties):
    """Layers of a transfer and how they are written; the scene keeps them for the panel, scripts give them."""

    layers: set[str] = EnumProperty(
        name="Layers",
        description="What the other meshes are given",
        options={"ENUM_FLAG"},
        items=[(kind, name, description) for kind, (name, description) in LAYERS.items()],
        default=set(DEFAULT_LAYERS),
    )
    method: str = EnumProperty(
        name="Found",
        description="How the place on the active mesh is found that each vertex belongs to",
        items=[
            ("AUTO", "Automatically", "By place where the mesh lies on the active one, by shape elsewhere"),
            ("PLACE", "By Place", "The nearest points: for clothes, hair and armor, or a mesh that replaces another"),
            ("SHAPE", "By Shape", "What corresponds by shape: for other poses and other characters, wherever they are"),
        ],
    )
    groups: str = EnumProperty(
        name="Groups",
        description="Which of the vertex groups the other meshes are given",
        items=[
            ("ALL", "All", "All vertex groups"),
            ("DEFORM", "Deform Bones", "Those of bones that deform the mesh"),
            ("NAMED", "Named", "Those that are named"),
        ],
    )
    group_names: str = StringProperty(name="Names", description="Names of vertex groups with commas between them")
    factor: float = FloatProperty(
        name="Mix",
        description="How much of what is there is replaced: 0 for nothing, 1 for all of it",
        subtype="FACTOR",
        min=0,
        max=1,
        default=1,
    )
    mask: str = StringProperty(
        name="Mask",
        description="Name of a vertex group of the other meshes: something is written only where it has weight",
    )
    unsure: str = EnumProperty(
        name="Unsure",
        description="What is written to vertices whose place on the active mesh is not sure",
        items=[
            ("TAKE", "Take Over", "What is found at the most likely place"),
            ("FILL", "Fill In", "What fits smoothly to the sure vertices around them"),
        ],
        default="FILL",
    )
    selects_unsure: bool = BoolProperty(
        name="Select Unsure", description="Select the vertices whose place is not sure, and no others"
    )
    mirrored: bool = BoolProperty(
        name="Mirrored",
        description="The other meshes are mirror images, such as a left glove and a right one; left and right are"
        " swapped in names",
    )
    use_modifiers: bool = BoolProperty(
        name="With Modifiers", description="Match the shapes as modifiers leave them; they must not change the faces"
    )


class EigenpartsTransferSettings(TransferOptions, bpy.types.PropertyGroup):
    """The options the panel shows."""


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsTransferSettings,))


def register() -> None:
    """Give scenes the options."""
    _register_classes()
    setattr(bpy.types.Scene, TRANSFER_SETTINGS, PointerProperty(type=EigenpartsTransferSettings))


def unregister() -> None:
    """Take them away again."""
    delattr(bpy.types.Scene, TRANSFER_SETTINGS)
    _unregister_classes()
