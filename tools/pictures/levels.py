"""The level slider: a character whole, at every level, and with all its fingers, and one hand enlarged beside it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from PIL import Image, ImageDraw

from eigenparts.operators.blender.known_values import mesh_of, present
from examples import Character, humanoid
from tools.extension_operators import run_operator
from tools.pictures.characters import add_mesh, analyze, level_of, segment, standing
from tools.pictures.lettering import FINENESS, PALE_INK, PAPER, fine_lines, paper, write
from tools.pictures.moving import Frame, write_gif
from tools.pictures.shots import light_on, shot_in_light
from tools.render import Pixels, Points, View

POSE = "wave"
N_VERTICES = 16000
HAND = ("hand.L", "thumb.L", "index.L", "middle.L", "ring.L", "little.L")
# Whatever stands out by a thousandth of the range, such as fingers.
FINE = 1e-3
WIDTH, HEIGHT = 720, 560
BODY, BODY_PLACE = (520, 500), (-10, -8)
# Of the enlarged hand: middle and radius.
LENS, LENS_RADIUS = (548, 196), 138
# Of the slider: left end, right end and height, half of the strip it lies in; what is passed and what is not.
TRACK, HALF = (40, 680, 530), 16
ACCENT, RAIL = (51, 153, 255), (205, 208, 212)
# Frames from one level to the next, how long each is shown and how long a level, the first and the last rest.
N_BETWEEN, STEP_TIME, REST_TIME, END_TIME = 3, 40, 520, 1900


@dataclass(frozen=True)
class Step:
    """The picture of one level.

    Attributes
    ----------
    level, n_parts : int
    image : PIL.Image.Image
        Without the slider.
    """

    level: int
    n_parts: int
    image: Image.Image


def draw(target: Path) -> None:
    """Write the moving picture."""
    character = humanoid(N_VERTICES)
    obj = add_mesh("Character", standing(character, character.poses[POSE]), character.quads)
    analyze(obj)
    segment(obj, threshold=FINE)
    finest, _, _ = level_of(obj)
    hand = hand_in_pose(character, POSE)
    whole = View(azimuth=18, width=BODY[0], height=BODY[1], samples=48)
    near = View(azimuth=18, width=2 * LENS_RADIUS, height=2 * LENS_RADIUS, samples=48, framed=hand)
    lit = [(view, light_on([obj], view)) for view in (whole, near)]
    write_gif(_frames([_step(obj, level, lit) for level in range(finest + 1)]), target)


def hand_in_pose(character: Character, pose: str) -> Points:
    """Return the vertices of the hand that is enlarged."""
    shown = [i for i, name in enumerate(character.fine_part_names) if name in HAND]
    return standing(character, character.poses[pose])[np.isin(character.fine_part_of_vertex, shown)].astype(np.float32)


def _step(obj: bpy.types.Object, level: int, lit: Sequence[tuple[View, Pixels]]) -> Step:
    cut = cut_copy(obj, level)
    body, lens = (shot_in_light(light, [cut], view) for view, light in lit)
    image = paper(WIDTH, HEIGHT)
    image.paste(body, BODY_PLACE)
    lay_lens(image, lens, LENS)
    return Step(level, level_of(cut)[2], image)


def cut_copy(obj: bpy.types.Object, level: int) -> bpy.types.Object:
    """Add a copy of an analyzed object in which the borders of a level run along edges."""
    copy = present(obj.copy())
    copy.data = mesh_of(obj).copy()
    present(bpy.context.collection).objects.link(copy)
    segment(copy, level=level)
    run_operator("cut")
    return copy


def lay_lens(image: Image.Image, lens: Image.Image, middle: tuple[int, int]) -> None:
    """Lay a square picture over another as a disc with a fine rim."""
    side = lens.width
    x, y = (place - side // 2 for place in middle)
    disc = Image.new("L", (FINENESS * side, FINENESS * side))
    ImageDraw.Draw(disc).ellipse((0, 0, FINENESS * side - 1, FINENESS * side - 1), fill=255)
    image.paste(lens, (x, y), disc.reduce(FINENESS))
    with fine_lines(image, (x - 2, y - 2, x + side + 2, y + side + 2)) as lines:
        edge = FINENESS * (side + 4) - 1
        lines.ellipse((FINENESS, FINENESS, edge - FINENESS, edge - FINENESS), outline=PALE_INK, width=FINENESS + 2)


def _frames(steps: Sequence[Step]) -> list[Frame]:
    """Return all frames: up level by level, and back from the last to the first."""
    frames = []
    finest = steps[-1].level
    for step, following in zip(steps, [*steps[1:], steps[0]], strict=True):
        rests = END_TIME if step.level in (0, finest) else REST_TIME
        frames.append(Frame(_with_slider(step, step.level, finest), rests))
        n_between = N_BETWEEN if following.level else 2 * N_BETWEEN
        for share in np.linspace(0, 1, n_between + 2)[1:-1]:
            place = (1 - share) * step.level + share * following.level
            frames.append(Frame(_with_slider(following if share > 0.5 else step, place, finest), STEP_TIME))
    return frames


def _with_slider(step: Step, place: float, finest: int) -> Image.Image:
    """Return a picture with the slider below, its handle at a level or between two."""
    drawn = step.image.copy()
    left, right, height = TRACK
    stops = [left + (right - left) * level / finest for level in range(finest + 1)]
    handle = left + (right - left) * place / finest
    with fine_lines(drawn, (0, height - HALF, WIDTH, height + HALF)) as lines:
        _line(lines, left, right, 2.5, RAIL)
        _line(lines, left, handle, 2.5, ACCENT)
        for stop in stops:
            _disc(lines, stop, 3.5, ACCENT if stop <= handle else RAIL)
        _disc(lines, handle, 11, ACCENT)
        _disc(lines, handle, 6.5, PAPER)
    write(drawn, (left, height - 24), f"Level {step.level}", 22, 600, anchor="ls")
    n_parts = "one part" if step.n_parts == 1 else f"{step.n_parts} parts"
    write(drawn, (right, height - 24), n_parts, 22, ink=PALE_INK, anchor="rs")
    return drawn


def _line(lines: ImageDraw.ImageDraw, start: float, end: float, half: float, ink: tuple[int, int, int]) -> None:
    box = (start, HALF - half, end, HALF + half)
    lines.rounded_rectangle([FINENESS * value for value in box], FINENESS * half, fill=ink)


def _disc(lines: ImageDraw.ImageDraw, middle: float, radius: float, ink: tuple[int, int, int]) -> None:
    lines.ellipse([FINENESS * v for v in (middle - radius, HALF - radius, middle + radius, HALF + radius)], fill=ink)
