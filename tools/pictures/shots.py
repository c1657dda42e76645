"""Renders as images of Pillow."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import bpy
from PIL import Image

from eigenparts.cli.processes.suppress_output import blender_is_quiet as quiet
from eigenparts.operators.blender.known_values import present
from tools.render import Pixels, View, light, paint_light, render


def shot(objects: Sequence[bpy.types.Object], view: View, in_front: Sequence[bpy.types.Object] = ()) -> Image.Image:
    """Return a picture of some objects as they are now, with others in front of them."""
    present(bpy.context.view_layer).update()
    with tempfile.TemporaryDirectory() as folder, quiet():
        path = render(objects, Path(folder) / "shot.png", view, in_front)
        return Image.open(path).convert("RGB")


def light_on(objects: Sequence[bpy.types.Object], view: View) -> Pixels:
    """Return the light on some objects, which stays while only their colours change."""
    present(bpy.context.view_layer).update()
    with tempfile.TemporaryDirectory() as folder, quiet():
        return light(objects, Path(folder) / "light.png", view)


def shot_in_light(lit: Pixels, objects: Sequence[bpy.types.Object], view: View) -> Image.Image:
    """Return a picture of objects in a light that is known."""
    present(bpy.context.view_layer).update()
    with tempfile.TemporaryDirectory() as folder, quiet():
        return Image.open(paint_light(lit, objects, Path(folder) / "shot.png", view)).convert("RGB")
