"""The means of drawing over the view: shaders, the projection, colours, and disks that face the viewer."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import cast

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from ..operators.blender.known_values import present

Opaque = tuple[float, float, float]
Colour = tuple[float, float, float, float]

DOT_CORNERS = 20
# Lines lie on faces; so much of the depth of the view they are drawn in front of them.
NEARER = 2e-5


@contextmanager
def drawing_over_faces() -> Iterator[None]:
    """Blend what the block draws, a little in front of where it is, and leave the state of the view as it was."""
    gpu.state.blend_set("ALPHA")
    gpu.matrix.push_projection()
    try:
        gpu.matrix.load_projection_matrix(_nearer(gpu.matrix.get_projection_matrix()))
        yield
    finally:
        gpu.matrix.pop_projection()
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


@contextmanager
def in_space_of(obj: bpy.types.Object) -> Iterator[None]:
    """Let the block draw in the coordinates of an object."""
    gpu.matrix.push()
    try:
        gpu.matrix.multiply_matrix(obj.matrix_world)
        yield
    finally:
        gpu.matrix.pop()


def shows_overlays(context: bpy.types.Context) -> bool:
    """Whether the 3D view that is drawn shows overlays."""
    view = context.space_data
    return isinstance(view, bpy.types.SpaceView3D) and view.overlay.show_overlays


def line_shader(colour: Colour, width: float) -> gpu.types.GPUShader:
    """Return the shader for lines of a width in pixels, at a scale of the interface of 1."""
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", in_pixels(width))
    shader.uniform_float("color", colour)
    return shader


def draw_lines(shader: gpu.types.GPUShader, ends: NDArray[np.float32]) -> None:
    """Draw a line between each two of (2n, 3) points."""
    batch_for_shader(shader, "LINES", {"pos": cast(Sequence[Sequence[float]], ends)}).draw(shader)


def draw_line_strip(shader: gpu.types.GPUShader, points: list[Vector]) -> None:
    """Draw a line through points."""
    batch_for_shader(shader, "LINE_STRIP", {"pos": cast(Sequence[Sequence[float]], points)}).draw(shader)


def draw_triangles(colour: Colour, corners: list[Vector]) -> None:
    """Fill triangles."""
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", colour)
    batch_for_shader(shader, "TRIS", {"pos": cast(Sequence[Sequence[float]], corners)}).draw(shader)


def in_pixels(length: float) -> float:
    """Return a length at the scale that the user gave the interface."""
    return length * present(bpy.context.preferences).system.ui_scale


def disk_facing_the_view(centre: Vector, view: Matrix, radius: float) -> list[Vector]:
    """Return the corners of triangles that make up a disk, turned to the viewer."""
    rotation = view.to_3x3().inverted()
    across, up = (rotation @ Vector(axis) * radius for axis in ((1, 0, 0), (0, 1, 0)))
    turn = Matrix.Rotation(6.283185307179586 / DOT_CORNERS, 2)
    spoke = Vector((1, 0))
    corners: list[Vector] = []
    for _ in range(DOT_CORNERS):
        following = turn @ spoke
        corners += [centre, *(centre + s.x * across + s.y * up for s in (spoke, following))]
        spoke = following
    return corners


def display_colour(linear: Sequence[float]) -> Opaque:
    """Return sRGB components, which the overlay is drawn in."""
    red, green, blue = (12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in linear)
    return red, green, blue


def _nearer(projection: Matrix) -> Matrix:
    """Return a projection that draws everything a little in front of where it is."""
    nearer = projection.copy()
    nearer[2] = nearer[2] - NEARER * nearer[3]
    return nearer
