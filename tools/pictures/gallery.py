"""Characters in several poses and at several levels; every pose has a triangulation of its own."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TypedDict

import bpy
import numpy as np
from PIL import Image

from eigenparts.compute import Analysis, Matching, TriangleMesh, analyze
from eigenparts.compute.registration.eigenfunctions.matching import matching_shape
from eigenparts.compute.registration.parts.population import label_matched, match_divisible, with_parts
from eigenparts.compute.registration.parts.transferred_labels import Divisible, divisible
from eigenparts.compute.surface.mesh import Floats, Ints32
from examples import Character, hand, humanoid, octopus, quadruped
from tools.pictures.characters import FINGERS_UP, add_mesh, paint_faces
from tools.pictures.lettering import sheet
from tools.pictures.shots import light_on, shot_in_light
from tools.render import Pixels, View

CELL = (260, 280)


class Level(TypedDict, total=False):
    """The choice of a level, by its number or by persistence."""

    level: int
    threshold: float


# Names of the rows and how the level of the reference is chosen.
LEVELS: dict[str, Level] = {"Few": {"level": 2}, "Default": {}, "Fine": {"threshold": 1e-3}}


@dataclass(frozen=True, eq=False)
class Subject:
    """A character as it is shown.

    Attributes
    ----------
    make : callable
        From a number of vertices to the character.
    poses : mapping of str to int
        Names, the reference first, and how many vertices each has.
    azimuth, elevation : float
        Degrees.
    upright : (3, 3) float
        Turns the character before it is put on the ground.
    """

    make: Callable[[int], Character]
    poses: dict[str, int]
    azimuth: float
    elevation: float
    upright: Floats

    @property
    def view(self) -> View:
        """From where it is seen."""
        return View(self.azimuth, self.elevation, *CELL, samples=32)

    def mesh(self, pose: str) -> TriangleMesh:
        """Return a pose, upright on the ground, with its own triangulation."""
        character = self.make(self.poses[pose])
        vertices = character.mesh_in_pose(pose) @ self.upright.T
        return TriangleMesh(vertices - [0, 0, vertices[:, 2].min()], character.triangles)


SUBJECTS = {
    "humanoid": Subject(humanoid, {"rest": 8000, "walk": 7000, "sit": 9000, "reach": 7500}, 18, 8, np.eye(3)),
    "quadruped": Subject(quadruped, {"rest": 7000, "walk": 6000, "run": 8000, "sit": 6500}, 52, 12, np.eye(3)),
    "octopus": Subject(octopus, {"rest": 7000, "swim": 6000, "reach": 8000, "curl": 6500}, 16, 32, np.eye(3)),
    "hand": Subject(hand, {"rest": 5000, "grip": 4000, "point": 6000, "victory": 4500}, 60, 8, FINGERS_UP),
}


@dataclass(frozen=True, eq=False)
class Family:
    """Analyzed poses, matched with the first.

    Attributes
    ----------
    reference : Analysis
    shapes : list of Divisible
        The first is that of the reference.
    matchings : list of Matching
        Of the reference with each of the others.
    """

    reference: Analysis
    shapes: list[Divisible]
    matchings: list[Matching]


def draw(name: str, target: Path) -> None:
    """Write the sheet of a character: levels below each other, poses side by side."""
    # Where the default level has all features, the fine one is the same again.
    told = {_told(name, level): level for level in reversed(LEVELS)}
    titles = [f"{level}\n{numbers}" for numbers, level in reversed(told.items())]
    sheet([_row(name, level) for level in reversed(told.values())], titles, [_titles(name)]).save(target)


def draw_registered(target: Path) -> None:
    """Write the sheet of all characters at the default level of their references."""
    rows = [_row(name, "Default") for name in SUBJECTS]
    titles = [f"{name.capitalize()}\n{_told(name, 'Default')}" for name in SUBJECTS]
    sheet(rows, titles, [_titles(name) for name in SUBJECTS]).save(target)


def added(mesh: TriangleMesh) -> bpy.types.Object:
    """Add a mesh to the scene."""
    return add_mesh("Character", mesh.vertices, mesh.triangles)


@cache
def _row(name: str, level: str) -> list[Image.Image]:
    """Return pictures of the poses in the parts that the first has at a level."""
    view, images = SUBJECTS[name].view, []
    for pose, labels in zip(SUBJECTS[name].poses, _labels(name, level), strict=True):
        obj = added(SUBJECTS[name].mesh(pose))
        paint_faces(obj, labels)
        images.append(shot_in_light(_light(name, pose), [obj], view))
    return images


@cache
def _light(name: str, pose: str) -> Pixels:
    return light_on([added(SUBJECTS[name].mesh(pose))], SUBJECTS[name].view)


def _labels(name: str, level: str) -> list[Ints32]:
    """Return the part of each triangle of each pose."""
    family = _family(name)
    own = family.reference.segment(mode="nested", **LEVELS[level])
    reference = with_parts(family.shapes[0], own.labels.astype(np.int64), own.parts, own.level)
    first_free = 1 + reference.parts.given.highest
    found = [
        label_matched(reference, shape, matching, first_free).faces
        for shape, matching in zip(family.shapes[1:], family.matchings, strict=True)
    ]
    return [own.labels, *found]


@cache
def _family(name: str) -> Family:
    analyses = [analyze(SUBJECTS[name].mesh(pose)) for pose in SUBJECTS[name].poses]
    shapes = [divisible(analysis, matching_shape(analysis)) for analysis in analyses]
    own = analyses[0].segment(mode="features")
    reference = with_parts(shapes[0], own.labels.astype(np.int64), own.parts, own.level)
    return Family(analyses[0], shapes, [match_divisible(reference, shape) for shape in shapes[1:]])


def _titles(name: str) -> list[str]:
    """Return names of the poses with the confidence that each is matched right."""
    first, *others = SUBJECTS[name].poses
    matched = zip(others, _family(name).matchings, strict=True)
    return [f"{first}, the reference", *(f"{pose}, {matching.confidence:.0%}" for pose, matching in matched)]


def _told(name: str, level: str) -> str:
    own = _family(name).reference.segment(mode="nested", **LEVELS[level])
    return f"level {own.level}, {len(own.parts.id)} parts"
