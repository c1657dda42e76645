"""What an analysis can be asked for, in the panel and in scripts."""

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, PointerProperty, StringProperty


class AnalysisOptions:
    """What an analysis can be asked for; the scene keeps it for the panel, the operator takes it from scripts."""

    field: EnumProperty(
        name="Field",
        description="The function on the surface whose hills become parts",
        items=[
            ("DIFFUSION", "Diffusion", "Finds every protrusion: limbs, heads, fingers, tails"),
            ("EIGENFUNCTION", "Eigenfunction", "One vibration mode; the first runs along the longest extent"),
            ("ATTRIBUTE", "Attribute", "Your own values: a float attribute of the vertices"),
        ],
    )
    eigenfunction: IntProperty(
        name="Number", description="Which eigenfunction, counted from the smoothest", default=1, min=1
    )
    attribute: StringProperty(
        name="Attribute", description="Name of the attribute that has your values, one decimal number for each vertex"
    )
    order: EnumProperty(
        name="Order",
        description="Degree of the finite elements: higher is more accurate and slower",
        items=[
            ("AUTO", "Automatic", "Cubic as long as it is cheap, then quadratic, then linear"),
            ("1", "Linear", "Fast, for large meshes"),
            ("2", "Quadratic", "Between the two"),
            ("3", "Cubic", "Most accurate"),
        ],
    )
    boundary: EnumProperty(
        name="Boundary",
        description="How the function behaves at open edges",
        items=[
            ("NEUMANN", "Free", "The function meets open edges at a right angle; right for most meshes"),
            ("DIRICHLET", "Fixed", "The function is zero at open edges; the mesh must have some"),
        ],
    )
    shells: EnumProperty(
        name="Loose Parts",
        description="What is done with a mesh of several loose parts",
        items=[
            ("BRIDGED", "Bridged", "Loose parts that prolong the largest are analyzed with it, as if they were joined"),
            ("LARGEST", "Largest", "Only the largest is analyzed; the others take the part of what they lie on"),
            ("SEPARATE", "Each by Itself", "Each that is no detail is divided on its own, as if it were alone"),
        ],
    )
    use_modifiers: BoolProperty(
        name="With Modifiers",
        description="Analyze the posed shape as modifiers leave it; they must not change the faces",
    )


class EigenpartsAnalysisSettings(AnalysisOptions, bpy.types.PropertyGroup):
    """The options the panel shows."""


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EigenpartsAnalysisSettings,))


def register() -> None:
    """Give scenes the options."""
    _register_classes()
    bpy.types.Scene.eigenparts = PointerProperty(type=EigenpartsAnalysisSettings)


def unregister() -> None:
    """Take them away again."""
    del bpy.types.Scene.eigenparts
    _unregister_classes()
