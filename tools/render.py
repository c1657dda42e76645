"""Pictures of divided meshes: flat part colours in soft light on a plain ground, by Cycles on the processor."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from math import radians, tan
from pathlib import Path
from typing import Literal, Protocol, cast

import bpy
import numpy as np
from mathutils import Matrix, Vector
from numpy.typing import NDArray

from eigenparts.operators.blender.known_values import elements_of, mesh_of, present, set_input

# (height, width, 4) RGBA, the lowest row first, or parts of it.
Pixels = NDArray[np.float32]
Points = NDArray[np.float32]

# Close to white, so that the palette's light colours still stand out.
BACKGROUND = 0.955
# Degrees; long enough a lens that nothing looks bent.
FIELD_OF_VIEW = 20.0
# How much of the picture's smaller side the object fills.
FILLED = 0.86
# Shadows fade out over this fraction of each side, so that pictures can lie side by side without a seam.
FADED = 0.2
# What hides more than this is no shadow, and what hides less than that no object.
OBJECT, SHADOW = 0.95, 0.6
# How much of what lies in front shows, so that the body is still seen behind it.
OPACITY = 0.88
# Materials whose names begin like this are shown as they are; all others are replaced.
MATERIAL = "eigenparts picture"
# The grey that light is found on, and rays a pixel for colours that shine by themselves.
CLAY, GLOW_SAMPLES = 0.45, 16
# Hidden less than this, the ground counts as lit: what the denoiser leaves.
LIT = 0.015
# The property of scenes that holds the settings of the renderer.
CYCLES = "cycles"


class _Cycles(Protocol):
    device: Literal["CPU", "GPU"]
    samples: int
    seed: int
    max_bounces: int
    use_denoising: bool
    denoising_prefilter: Literal["NONE", "FAST", "ACCURATE"]


@dataclass(frozen=True, eq=False)
class View:
    """From where a picture is taken.

    Attributes
    ----------
    azimuth, elevation : float
        Degrees; azimuth 0 looks along +y, as Blender's front view does.
    width, height : int
        Pixels.
    samples : int
        Rays a pixel.
    framed : (N, 3) float32, optional
        The points that fill the picture; those of the objects if None.
    """

    azimuth: float = 24.0
    elevation: float = 10.0
    width: int = 600
    height: int = 750
    samples: int = 12
    framed: Points | None = None


def render(
    objects: Sequence[bpy.types.Object],
    path: Path,
    view: View | None = None,
    in_front: Sequence[bpy.types.Object] = (),
) -> Path:
    """Write a PNG of some objects in the colours of their parts, and leave the file that is open as it was.

    What has no parts has its object's colour. What is in front is seen through the objects, as bones are.
    """
    view = view or View()
    bodies, bones = ([_posed_copy(obj) for obj in group] for group in (objects, in_front))
    with _stage(bodies, view) as (scene, ground):
        for bone in bones:
            scene.collection.objects.link(bone)
        pixels = _over(_faded(_taken(scene, path, hidden=bones)), BACKGROUND)
        if bones:
            before = _taken(scene, path, hidden=[*bodies, ground])
            before[..., 3] *= OPACITY
            pixels = _over(before, pixels)
    _save(pixels, path)
    return path


def light(objects: Sequence[bpy.types.Object], path: Path, view: View) -> Pixels:
    """Return (height, width, 4) light on some objects and their shadow, whatever their colours; a file is written."""
    with _stage([_posed_copy(obj, _material("", CLAY)) for obj in objects], view) as (scene, _):
        return _taken(scene, path, hidden=[])


def paint_light(lit: Pixels, objects: Sequence[bpy.types.Object], path: Path, view: View) -> Path:
    """Write a PNG of objects in the light that was found before: much faster, and it never flickers."""
    with _stage([_posed_copy(obj, _glowing("part_color")) for obj in objects], view) as (scene, ground):
        cycles = _cycles(scene)
        cycles.samples, cycles.use_denoising, cycles.max_bounces = GLOW_SAMPLES, False, 0
        colours = _taken(scene, path, hidden=[ground])
    shown, is_object = lit.copy(), colours[..., 3] > 0
    reflected = _linear(lit[is_object, :3]) / CLAY * _linear(colours[is_object, :3])
    shown[is_object, :3] = _as_on_screen(np.minimum(reflected, 1))
    _save(_over(_faded(shown), BACKGROUND), path)
    return path


@contextmanager
def _stage(copies: Sequence[bpy.types.Object], view: View) -> Iterator[tuple[bpy.types.Scene, bpy.types.Object]]:
    """Put objects into a scene of their own with camera, light and ground; all of it is gone afterwards."""
    scene = bpy.data.scenes.new("eigenparts picture")
    try:
        for copy in copies:
            scene.collection.objects.link(copy)
        _set_up(scene, view)
        yield scene, _aim(scene, view, np.concatenate([world_positions(copy) for copy in copies]))
    finally:
        _take_down(scene)


def side_by_side(paths: Sequence[Path], target: Path) -> Path:
    """Write one PNG with pictures of equal height in a row."""
    _save(np.concatenate([_pixels(path) for path in paths], axis=1), target)
    return target


def world_positions(obj: bpy.types.Object) -> Points:
    """Return the (V, 3) float32 vertices of an object in the space of the scene."""
    mesh = mesh_of(obj)
    positions = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    elements_of(mesh.attributes["position"]).foreach_get("vector", positions)
    matrix = np.array(obj.matrix_world, dtype=np.float32)
    return positions.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def _posed_copy(obj: bpy.types.Object, material: bpy.types.Material | None = None) -> bpy.types.Object:
    """Return an object with the evaluated mesh and nothing but one material; ours that suits it if none is given."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bpy.data.meshes.new_from_object(evaluated)
    own = [material for material in mesh.materials if material and material.name.startswith(MATERIAL)]
    mesh.materials.clear()
    suiting = own[0] if own else _material("part_color" if "part_color" in mesh.attributes else "")
    mesh.materials.append(material or suiting)
    copy = bpy.data.objects.new("picture", mesh)
    copy.matrix_world = obj.matrix_world
    copy.color = obj.color
    return copy


def _material(attribute: str, grey: float | None = None) -> bpy.types.Material:
    """Return a material in the colours of an attribute, or of the object if it has no name, or in a grey."""
    name = f"{MATERIAL} {attribute} {grey}"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    material, nodes = _nodes(name)
    surface = nodes["Principled BSDF"]
    set_input(surface, "Roughness", 0.55)
    set_input(surface, "Specular IOR Level", 0.25)
    if grey is not None:
        set_input(surface, "Base Color", (grey, grey, grey, 1))
        return material
    colour = _attribute_colour(nodes, attribute) if attribute else nodes.new("ShaderNodeObjectInfo")
    present(material.node_tree).links.new(colour.outputs["Color"], surface.inputs["Base Color"])
    return material


def _glowing(attribute: str) -> bpy.types.Material:
    """Return a material that shines in the colours of an attribute, whatever the light."""
    name = f"{MATERIAL} {attribute} glowing"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    material, nodes = _nodes(name)
    colour, shine = _attribute_colour(nodes, attribute), nodes.new("ShaderNodeEmission")
    links = present(material.node_tree).links
    links.new(colour.outputs["Color"], shine.inputs["Color"])
    links.new(shine.outputs["Emission"], nodes["Material Output"].inputs["Surface"])
    return material


def _attribute_colour(nodes: bpy.types.Nodes, attribute: str) -> bpy.types.Node:
    """Add a node that gives the colours of an attribute."""
    colour = nodes.new("ShaderNodeVertexColor")
    assert isinstance(colour, bpy.types.ShaderNodeVertexColor)
    colour.layer_name = attribute
    return colour


def _nodes(name: str) -> tuple[bpy.types.Material, bpy.types.Nodes]:
    """Return a new material and its nodes."""
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    return material, present(material.node_tree).nodes


def _set_up(scene: bpy.types.Scene, view: View) -> None:
    # The stubs know only the engines that are part of Blender itself.
    scene.render.engine = "CYCLES"  # type: ignore[assignment]
    cycles = _cycles(scene)
    cycles.device, cycles.samples, cycles.seed = "CPU", view.samples, 0
    cycles.use_denoising, cycles.denoising_prefilter = True, "FAST"
    scene.render.film_transparent = True
    scene.render.resolution_x, scene.render.resolution_y = view.width, view.height
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    # The palette is made for the screen as it is, not for a film look.
    # The stubs know none of the transforms, which Blender reads from a file.
    present(scene.view_settings).view_transform = "Standard"  # type: ignore[assignment]
    scene.world = world = bpy.data.worlds.new("eigenparts picture")
    if world.node_tree is None:
        world.use_nodes = True
    background = present(world.node_tree).nodes["Background"]
    set_input(background, "Color", (0.9, 0.95, 1.0, 1.0))
    set_input(background, "Strength", 0.6)


def _cycles(scene: bpy.types.Scene) -> _Cycles:
    """Return the settings of the renderer that is an extension itself."""
    return getattr(scene, CYCLES)


def _aim(scene: bpy.types.Scene, view: View, positions: Points) -> bpy.types.Object:
    """Add camera and light to suit what is shown, and the ground below the objects, which is returned."""
    corners = positions if view.framed is None else view.framed
    centre = Vector((corners.min(axis=0) + corners.max(axis=0)) / 2)
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    turn = Matrix.Rotation(radians(view.azimuth), 4, "Z") @ Matrix.Rotation(radians(90 - view.elevation), 4, "X")
    _add_camera(scene, view, corners, centre, turn)
    _add_light(
        scene, centre, size, turn @ Matrix.Rotation(radians(-50), 4, "X") @ Matrix.Rotation(radians(-25), 4, "Y")
    )
    return _add_ground(scene, centre, size, float(positions[:, 2].min()))


def _add_camera(scene: bpy.types.Scene, view: View, corners: Points, centre: Vector, turn: Matrix) -> None:
    data = bpy.data.cameras.new("picture")
    data.sensor_fit, data.angle = "VERTICAL", radians(FIELD_OF_VIEW)
    seen = (corners - np.array(centre)) @ np.array(turn.to_3x3())
    half_height = tan(radians(FIELD_OF_VIEW / 2))
    half = np.array([half_height * view.width / view.height, half_height]) * FILLED
    # Every point is inside the picture from a distance that its own depth and offset ask for.
    distance = float((np.abs(seen[:, :2]) / half + seen[:, 2:]).max())
    data.clip_start, data.clip_end = distance / 100, distance * 100
    camera = bpy.data.objects.new("picture", data)
    camera.matrix_world = Matrix.Translation(centre.to_tuple()) @ turn @ Matrix.Translation((0, 0, distance))
    scene.collection.objects.link(camera)
    scene.camera = camera


def _add_light(scene: bpy.types.Scene, centre: Vector, size: float, turn: Matrix) -> None:
    data = bpy.data.lights.new("picture", "SUN")
    assert isinstance(data, bpy.types.SunLight)
    data.energy, data.angle = 2.4, radians(60)
    light = bpy.data.objects.new("picture", data)
    light.matrix_world = Matrix.Translation(centre.to_tuple()) @ turn @ Matrix.Translation((0, 0, 2 * size))
    scene.collection.objects.link(light)


def _add_ground(scene: bpy.types.Scene, centre: Vector, size: float, height: float) -> bpy.types.Object:
    """Add a ground that shows nothing but the shadow on it."""
    reach = 4 * size
    corners = [(centre.x + x * reach, centre.y + y * reach, height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh = bpy.data.meshes.new("picture")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    ground = bpy.data.objects.new("picture", mesh)
    ground.is_shadow_catcher = True
    scene.collection.objects.link(ground)
    return ground


def _taken(scene: bpy.types.Scene, path: Path, hidden: Sequence[bpy.types.Object]) -> Pixels:
    """Return what the camera sees, (height, width, 4), without some objects; a file is written on the way."""
    for obj in scene.collection.objects:
        obj.hide_render = obj in hidden
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
    return _pixels(path)


def _faded(pixels: Pixels) -> Pixels:
    """Return a picture whose shadows pass into nothing at its sides."""
    height, width, _ = pixels.shape
    down, across = (
        _smooth(np.minimum(place, 1 - place) / FADED)
        for place in ((np.arange(n, dtype=np.float32) + 0.5) / n for n in (height, width))
    )
    shadow = 1 - _smooth((pixels[..., 3] - SHADOW) / (OBJECT - SHADOW))
    faded = pixels.copy()
    faded[..., 3] = np.maximum(faded[..., 3] - LIT, 0) / (1 - LIT) * (1 - shadow * (1 - down[:, None] * across))
    return faded


def _linear(colours: Pixels) -> Pixels:
    """Return linear values of those of the screen."""
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def _as_on_screen(values: Pixels) -> Pixels:
    """Return values of the screen of linear ones."""
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * values ** (1 / 2.4) - 0.055)


def _smooth(share: Pixels) -> Pixels:
    """Return values that rise from 0 to 1 as the share does, without corners."""
    share = np.clip(share, 0, 1)
    return share * share * (3 - 2 * share)


def _take_down(scene: bpy.types.Scene) -> None:
    objects = list(scene.collection.objects)
    data = [obj.data for obj in objects]
    world = scene.world
    bpy.data.scenes.remove(scene)
    bpy.data.batch_remove([*objects, *data, *([world] if world else [])])


def _over(pixels: Pixels, below: Pixels | float) -> Pixels:
    """Return a picture laid over another one, or over a grey."""
    laid = np.ones_like(pixels)
    below = below[..., :3] if isinstance(below, np.ndarray) else below
    laid[..., :3] = pixels[..., :3] * pixels[..., 3:] + below * (1 - pixels[..., 3:])
    return laid


def _pixels(path: Path) -> Pixels:
    """Return (height, width, 4) of an image, bottom row first."""
    image = bpy.data.images.load(str(path))
    width, height = cast(tuple[int, int], image.size)
    pixels = np.empty(4 * width * height, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)


def _save(pixels: Pixels, path: Path) -> None:
    height, width, _ = pixels.shape
    image = bpy.data.images.new("picture", width, height, alpha=True)
    image.pixels.foreach_set(cast(Sequence[float], np.ascontiguousarray(pixels).ravel()))
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
