"""Rendered pictures of the listing: characters of the project in one light, on one paper, with one lettering."""

from collections.abc import Sequence
from math import radians

import bpy
import numpy as np
from PIL import Image, ImageDraw

from eigenparts.compute.surface.mesh import Floats
from eigenparts.operators.blender.known_values import mesh_of
from examples import Character, hand, humanoid, octopus, quadruped
from tools.extension_operators import run_operator
from tools.pictures import skeletons, transferred
from tools.pictures.bones import bone_objects
from tools.pictures.characters import FINGERS_UP, add_mesh, analyze, level_of, segment, select, standing
from tools.pictures.lettering import PALE_INK, paper, write
from tools.pictures.levels import cut_copy, hand_in_pose, lay_lens
from tools.pictures.shots import light_on, shot, shot_in_light
from tools.render import Points, View, world_positions

WIDTH, HEIGHT = 1920, 1080
# Of the lettering: left margin, heights of the baselines of title and second line, and of the labels.
LEFT, TITLE_LINE, SECOND_LINE, LABEL_LINE = 96, 126, 182, 1012
TITLE_SIZE, SECOND_SIZE, LABEL_SIZE = 60, 31, 27
# Of what is rendered: top, and height to the labels.
TOP, TALL = 200, 770
SAMPLES = 24
# Vertices; so many that no triangle shows.
FINE_MESH = 10000
# Whatever stands out by a thousandth of the range, such as fingers.
FINE = 1e-3
# Drawn twice as large, which smooths its corners.
ICON, ROUNDING = 256, 44
# Across a pose beside one whose arms are spread.
NARROW = 410
# Across what is beside the name.
FEATURED = 1160
# Across the enlarged hand.
LENS = 340
# How much of the hand, from the tips of its fingers, fills the icon.
IN_ICON = 0.74
# How much larger than a character with bones the space is that is shown of it.
MARGIN = 1.1
# Metres around one who stands: half across, half in depth, height.
ROOM = 0.46, 0.2, 1.95


def icon() -> Image.Image:
    """Return a hand in its parts on a square with round corners; what is outside is transparent."""
    side = 2 * ICON
    character = hand(FINE_MESH)
    upright = character.mesh_in_pose("rest") @ FINGERS_UP.T
    obj = add_mesh("Hand", upright - [0, 0, upright[:, 2].min()], character.quads)
    _divide(obj, threshold=FINE)
    points = world_positions(obj)
    framed = points[points[:, 2] > (1 - IN_ICON) * points[:, 2].max()]
    view = View(azimuth=60, elevation=8, width=side, height=side, samples=SAMPLES, framed=framed)
    image = shot([obj], view).convert("RGBA")
    corners = Image.new("L", (side, side))
    ImageDraw.Draw(corners).rounded_rectangle((0, 0, side - 1, side - 1), 2 * ROUNDING, fill=255)
    image.putalpha(corners)
    return image.reduce(2)


def featured(name: str, lines: Sequence[str]) -> Image.Image:
    """Return three characters beside the name and what it is."""
    objects = [
        _stand(humanoid(FINE_MESH), "wave"),
        _stand(quadruped(FINE_MESH), "sit", (-0.72, -0.45), -14),
        _stand(octopus(FINE_MESH), "reach", (0.86, -0.62), 20, 0.5),
    ]
    for obj in objects:
        _divide(obj)
    image = paper(WIDTH, HEIGHT)
    view = View(azimuth=10, elevation=10, width=FEATURED, height=HEIGHT, samples=SAMPLES)
    image.paste(shot(objects, view), (WIDTH - FEATURED, 0))
    write(image, (LEFT, 520), name, 120, 700, anchor="ls")
    for number, line in enumerate(lines):
        write(image, (LEFT + 4, 600 + 52 * number), line, 38, ink=PALE_INK, anchor="ls")
    return image


def levels(title: str, line: str, shown: Sequence[int]) -> Image.Image:
    """Return one character at several levels, and its hand at the finest one."""
    character = humanoid(FINE_MESH)
    obj = _stand(character, "wave")
    analyze(obj)
    segment(obj, threshold=FINE)
    finest = level_of(obj)[0]
    view = _column(len(shown) + 1, _room())
    lit = light_on([obj], view)
    copies = [cut_copy(obj, level) for level in (*shown, finest)]
    images = [shot_in_light(lit, [copy], view) for copy in copies[:-1]]
    near = View(18, width=LENS, height=LENS, samples=SAMPLES, framed=hand_in_pose(character, "wave"))
    images.append(paper(view.width, view.height))
    lay_lens(images[-1], shot(copies[-1:], near), (view.width // 2, view.height // 2))
    labels = [f"level {level_of(copy)[0]}: {level_of(copy)[2]} parts" for copy in copies]
    return _row(title, line, images, labels)


def poses(title: str, line: str, shown: Sequence[tuple[str, int]]) -> Image.Image:
    """Return poses, each with vertices of its own, registered with the first; some have facets, some are smooth."""
    objects = [_stand(humanoid(n_vertices), pose) for pose, n_vertices in shown]
    analyze(objects[0])
    for number, obj in enumerate(objects[1:]):
        select([obj, objects[0]])
        run_operator("register_selected")
        if number % 2 == 0:
            mesh_of(obj).shade_flat()
    view = _column(len(shown), _room())
    labels = [f"{pose}, {len(mesh_of(obj).vertices):,} vertices" for (pose, _), obj in zip(shown, objects, strict=True)]
    return _row(title, line, [shot([obj], view) for obj in objects], labels)


def bones(title: str, line: str) -> Image.Image:
    """Return characters with their armatures, and one that is posed with it."""
    dog, body = _stand(quadruped(FINE_MESH), "rest"), _stand(humanoid(), "rest")
    armatures = [_with_armature(obj) for obj in (dog, body)]
    around_dog, around_body = world_positions(dog), world_positions(body)
    images = [_with_bones(dog, armatures[0], 52, around_dog), _with_bones(body, armatures[1], 20, around_body)]
    skeletons.pose(armatures[1])
    images.append(_with_bones(body, armatures[1], 20, around_body))
    return _row(title, line, images, ["made for a quadruped", "made for a body at rest", "the same, posed"])


def weights(title: str, line: str) -> Image.Image:
    """Return weights of one mesh, whose arms are spread, and what others get of them."""
    images: list[Image.Image] = []
    for mesh, values in zip(transferred.posed(), transferred.carried_weights(), strict=True):
        obj = add_mesh("Mesh", mesh.vertices, mesh.triangles)
        transferred.paint_values(obj, values)
        width = NARROW if images else WIDTH - 3 * NARROW
        images.append(shot([obj], View(18, 8, width, TALL, SAMPLES, _room(0.3, 1.72))))
    return _row(title, line, images, transferred.titles())


def titled(title: str, line: str) -> Image.Image:
    """Return a sheet with its title and a line below it."""
    image = paper(WIDTH, HEIGHT)
    write(image, (LEFT, TITLE_LINE), title, TITLE_SIZE, 650, anchor="ls")
    write(image, (LEFT, SECOND_LINE), line, SECOND_SIZE, ink=PALE_INK, anchor="ls")
    return image


def _row(title: str, line: str, images: Sequence[Image.Image], labels: Sequence[str]) -> Image.Image:
    sheet = titled(title, line)
    left = 0
    for image, label in zip(images, labels, strict=True):
        sheet.paste(image, (left, TOP))
        write(sheet, (left + image.width / 2, LABEL_LINE), label, LABEL_SIZE, ink=PALE_INK, anchor="ms")
        left += image.width
    return sheet


def _column(n_columns: int, framed: Points) -> View:
    return View(azimuth=18, elevation=8, width=WIDTH // n_columns, height=TALL, samples=SAMPLES, framed=framed)


def _room(half_width: float = ROOM[0], height: float = ROOM[2]) -> Points:
    """Return corners of the box in which a character stands."""
    across, deep = (-half_width, half_width), (-ROOM[1], ROOM[1])
    return np.array([(x, y, z) for x in across for y in deep for z in (0, height)], dtype=np.float32)


def _with_armature(obj: bpy.types.Object) -> bpy.types.Object:
    """Return the armature that an object is given, after which the borders of its parts run along edges."""
    armature = skeletons.rigged(obj)
    select([obj])
    run_operator("cut")
    return armature


def _with_bones(obj: bpy.types.Object, armature: bpy.types.Object, azimuth: float, around: Points) -> Image.Image:
    """Return a third of a row, which has a margin around some points."""
    centre = (around.min(axis=0) + around.max(axis=0)) / 2
    framed = centre + MARGIN * (around - centre)
    view = View(azimuth, 10, WIDTH // 3, TALL, SAMPLES, framed)
    return shot([obj], view, bone_objects(armature))


def _stand(
    character: Character, pose: str, place: tuple[float, float] = (0, 0), turn: float = 0, scale: float = 1
) -> bpy.types.Object:
    """Add a character in a pose, on the ground."""
    vertices: Floats = standing(character, character.poses[pose])
    obj = add_mesh(character.name, vertices, character.quads)
    obj.location.xy = place
    obj.rotation_euler.z = radians(turn)
    obj.scale = (scale, scale, scale)
    return obj


def _divide(obj: bpy.types.Object, **choice: float) -> None:
    """Analyze an object, and let the borders of its parts run along edges."""
    analyze(obj)
    if choice:
        segment(obj, **choice)
    run_operator("cut")
