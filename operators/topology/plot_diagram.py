"""Operator: draw the persistence diagram and the persistence curve of the field into an image."""

from collections.abc import Sequence
from typing import cast

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_analysis import AnalyzedShape
from ..blender.known_values import values_of
from ..parts.fresh_analysis import FreshAnalysis
from .diagram_picture import Plotted, draw_diagram
from .lettering import Lettering

# The object an image of ours belongs to, so that it is drawn over and no other image is.
OF_OBJECT = "eigenparts_diagram"


class EIGENPARTS_OT_plot_diagram(FreshAnalysis, bpy.types.Operator):
    """Draw which features the field of the active mesh has and how prominent each is, into an image"""

    bl_idname = "eigenparts.plot_diagram"
    bl_label = "Plot Diagram"
    bl_options = {"UNDO"}

    def show(self, context: bpy.types.Context, obj: bpy.types.Object, shape: AnalyzedShape) -> str:
        analysis = shape.analysis
        title = f"Persistence diagram of {obj.name}, {analysis.field.name}"
        plotted = Plotted(title, analysis.diagram, compute.NOISE_THRESHOLD, compute.DEFAULT_THRESHOLD)
        with Lettering() as letters:
            image = write_image(obj.name, draw_diagram(plotted, letters.triangles))
        show_image(context, image)
        return f'The diagram is in the image "{image.name}".'


def write_image(name: str, pixels: NDArray[np.float32]) -> bpy.types.Image:
    """Put a picture, (height, width, 3) in sRGB, into the image of an object and keep it in the file."""
    height, width = pixels.shape[:2]
    image = next((image for image in bpy.data.images if image.get(OF_OBJECT) == name), None)
    if image is None:
        image = bpy.data.images.new(f"Diagram of {name}", width, height)
        image[OF_OBJECT] = name
    elif tuple(values_of(image.size)) != (width, height):
        image.scale(width, height)
    opaque = np.ones((height, width, 4), dtype=np.float32)
    opaque[..., :3] = pixels
    image.pixels.foreach_set(cast(Sequence[float], opaque.ravel()))
    image.update()
    image.pack()
    return image


def show_image(context: bpy.types.Context, image: bpy.types.Image) -> None:
    """Show an image in every image editor of the window."""
    for area in context.screen.areas if context.screen else ():
        editor = area.spaces.active
        if isinstance(editor, bpy.types.SpaceImageEditor):
            editor.image = image


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_plot_diagram,))
