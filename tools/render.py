"""Pictures of divided meshes: flat part colours in soft light on a plain ground, by Cycles on the processor."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import radians, tan
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector

# Close to white, so that the palette's light colours still stand out.
BACKGROUND = 0.955
# Degrees; long enough a lens that nothing looks bent.
FIELD_OF_VIEW = 20.0
# How much of the picture's smaller side the object fills.
FILLED = 0.86


@dataclass(frozen=True)
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
    """

    azimuth: float = 24.0
    elevation: float = 10.0
    width: int = 600
    height: int = 750
    samples: int = 12


def render(objects: Sequence[bpy.types.Object], path: Path, view: View | None = None) -> Path:
    """Write a PNG of some objects in the colours of their parts, and leave the file that is open as it was."""
    view = view or View()
    scene = bpy.data.scenes.new("eigenparts picture")
    try:
        for obj in objects:
            scene.collection.objects.link(_posed_copy(obj))
        _set_up(scene, view)
        _aim(scene, view)
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True, scene=scene.name)
    finally:
        _take_down(scene)
    _lay_on_background(path)
    return path


def side_by_side(paths: Sequence[Path], target: Path) -> Path:
    """Write one PNG with pictures of equal height in a row."""
    _save(np.concatenate([_pixels(path) for path in paths], axis=1), target)
    return target


def _posed_copy(obj: bpy.types.Object) -> bpy.types.Object:
    """Return an object with the evaluated mesh and nothing but our material."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = bpy.data.meshes.new_from_object(evaluated)
    mesh.materials.clear()
    mesh.materials.append(_part_material())
    copy = bpy.data.objects.new("picture", mesh)
    copy.matrix_world = obj.matrix_world
    return copy


def _part_material() -> bpy.types.Material:
    name = "eigenparts picture"
    if name in bpy.data.materials:
        return bpy.data.materials[name]
    material = bpy.data.materials.new(name)
    if material.node_tree is None:
        material.use_nodes = True
    surface = material.node_tree.nodes["Principled BSDF"]
    surface.inputs["Roughness"].default_value = 0.55
    surface.inputs["Specular IOR Level"].default_value = 0.25
    colour = material.node_tree.nodes.new("ShaderNodeVertexColor")
    colour.layer_name = "part_color"
    material.node_tree.links.new(colour.outputs["Color"], surface.inputs["Base Color"])
    return material


def _set_up(scene: bpy.types.Scene, view: View) -> None:
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = view.samples
    scene.cycles.use_denoising = True
    scene.cycles.seed = 0
    scene.render.film_transparent = True
    scene.render.resolution_x, scene.render.resolution_y = view.width, view.height
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    # The palette is made for the screen as it is, not for a film look.
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("eigenparts picture")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.9, 0.95, 1.0, 1.0)
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.6


def _aim(scene: bpy.types.Scene, view: View) -> None:
    """Add camera, light and ground to suit what is in the scene."""
    corners = np.concatenate([_world_positions(obj) for obj in scene.collection.objects])
    centre = Vector((corners.min(axis=0) + corners.max(axis=0)) / 2)
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    turn = Matrix.Rotation(radians(view.azimuth), 4, "Z") @ Matrix.Rotation(radians(90 - view.elevation), 4, "X")
    _add_camera(scene, view, corners, centre, turn)
    _add_light(
        scene, centre, size, turn @ Matrix.Rotation(radians(-50), 4, "X") @ Matrix.Rotation(radians(-25), 4, "Y")
    )
    _add_ground(scene, centre, size, float(corners[:, 2].min()))


def _add_camera(scene: bpy.types.Scene, view: View, corners: np.ndarray, centre: Vector, turn: Matrix) -> None:
    data = bpy.data.cameras.new("picture")
    data.sensor_fit, data.angle = "VERTICAL", radians(FIELD_OF_VIEW)
    seen = (corners - np.array(centre)) @ np.array(turn.to_3x3())
    half_height = tan(radians(FIELD_OF_VIEW / 2))
    half = np.array([half_height * view.width / view.height, half_height]) * FILLED
    # Every point is inside the picture from a distance that its own depth and offset ask for.
    distance = float((np.abs(seen[:, :2]) / half + seen[:, 2:]).max())
    data.clip_start, data.clip_end = distance / 100, distance * 100
    camera = bpy.data.objects.new("picture", data)
    camera.matrix_world = Matrix.Translation(centre) @ turn @ Matrix.Translation((0, 0, distance))
    scene.collection.objects.link(camera)
    scene.camera = camera


def _add_light(scene: bpy.types.Scene, centre: Vector, size: float, turn: Matrix) -> None:
    data = bpy.data.lights.new("picture", "SUN")
    data.energy, data.angle = 2.4, radians(60)
    light = bpy.data.objects.new("picture", data)
    light.matrix_world = Matrix.Translation(centre) @ turn @ Matrix.Translation((0, 0, 2 * size))
    scene.collection.objects.link(light)


def _add_ground(scene: bpy.types.Scene, centre: Vector, size: float, height: float) -> None:
    """Add a ground that shows nothing but the shadow on it."""
    reach = 4 * size
    corners = [(centre.x + x * reach, centre.y + y * reach, height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    mesh = bpy.data.meshes.new("picture")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    ground = bpy.data.objects.new("picture", mesh)
    ground.is_shadow_catcher = True
    scene.collection.objects.link(ground)


def _world_positions(obj: bpy.types.Object) -> np.ndarray:
    positions = np.empty(3 * len(obj.data.vertices), dtype=np.float32)
    obj.data.attributes["position"].data.foreach_get("vector", positions)
    matrix = np.array(obj.matrix_world)
    return positions.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def _take_down(scene: bpy.types.Scene) -> None:
    objects = list(scene.collection.objects)
    data = [obj.data for obj in objects]
    world = scene.world
    bpy.data.scenes.remove(scene)
    bpy.data.batch_remove([*objects, *data, *([world] if world else [])])


def _lay_on_background(path: Path) -> None:
    pixels = _pixels(path)
    alpha = pixels[..., 3:]
    pixels[..., :3] = pixels[..., :3] * alpha + BACKGROUND * (1 - alpha)
    pixels[..., 3] = 1
    _save(pixels, path)


def _pixels(path: Path) -> np.ndarray:
    """Return (height, width, 4) of an image, bottom row first."""
    image = bpy.data.images.load(str(path))
    pixels = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(pixels)
    width, height = image.size
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)


def _save(pixels: np.ndarray, path: Path) -> None:
    height, width, _ = pixels.shape
    image = bpy.data.images.new("picture", width, height, alpha=True)
    image.pixels.foreach_set(np.ascontiguousarray(pixels).ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
