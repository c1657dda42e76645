"""Armatures inside the meshes that they were made for, and a character posed with the one that it was given."""

from math import radians
from pathlib import Path
from typing import Literal

import bpy
import numpy as np
from mathutils import Matrix

from eigenparts.compute.surface.mesh import Floats
from eigenparts.operators.blender.known_values import data_of, present
from examples import humanoid
from tools.extension_operators import run_operator
from tools.pictures.bones import bone_objects
from tools.pictures.characters import add_mesh, analyze, select, standing
from tools.pictures.gallery import SUBJECTS, added
from tools.pictures.lettering import sheet
from tools.pictures.shots import shot
from tools.render import View

# Joints near which bones begin, and how these are turned: degrees about an axis of the scene.
POSE: tuple[tuple[tuple[float, float, float], float, Literal["X", "Y", "Z"]], ...] = (
    ((0.15, 0, 1.3), 55, "Y"),
    ((0.42, 0, 1.3), -50, "Z"),
    ((-0.15, 0, 1.3), -60, "Y"),
    ((-0.42, 0, 1.3), 70, "Z"),
    ((0.09, 0, 0.8), -70, "X"),
    ((0.1, 0, 0.43), 85, "X"),
    ((0, 0, 1.42), 25, "Z"),
    ((0, 0, 1.08), 14, "Y"),
)


def draw_examples(target: Path) -> None:
    """Write the characters of the project with their armatures."""
    images = []
    for subject in SUBJECTS.values():
        obj = added(subject.mesh("rest"))
        images.append(shot([obj], subject.view, bone_objects(rigged(obj))))
    sheet([images]).save(target)


def draw_posed(target: Path) -> None:
    """Write the humanoid, and the same posed with the armature it was given."""
    character = humanoid()
    obj = add_mesh("Humanoid", standing(character, character.poses["rest"]), character.quads)
    armature = rigged(obj)
    view = View(azimuth=20, elevation=8, width=460, height=480)
    images = [shot([obj], view, bone_objects(armature))]
    pose(armature)
    images.append(shot([obj], view, bone_objects(armature)))
    sheet([images]).save(target)


def rigged(obj: bpy.types.Object) -> bpy.types.Object:
    """Analyze an object, and return the armature that it is given."""
    analyze(obj)
    select([obj])
    run_operator("create_armature")
    return present(bpy.context.object)


def pose(armature: bpy.types.Object) -> None:
    """Raise one arm, bend the other, lift a knee, turn the head and lean: each by the bones that lie there."""
    for joint, degrees, axis in POSE:
        posed = present(armature.pose).bones[_bone_at(armature, np.array(joint))]
        at_rest = posed.bone.matrix_local
        pivot = Matrix.Translation(posed.bone.head_local.to_tuple())
        motion = pivot @ Matrix.Rotation(radians(degrees), 4, axis) @ pivot.inverted()
        posed.matrix_basis = at_rest.inverted() @ motion @ at_rest


def _bone_at(armature: bpy.types.Object, place: Floats) -> str:
    """Return the bone that begins nearest to a place and leads away from the body."""
    bones = [
        bone for bone in data_of(armature, bpy.types.Armature).bones if bone.parent and not bone.name.startswith("Root")
    ]
    return min(bones, key=lambda bone: float(np.linalg.norm(np.array(bone.head_local) - place))).name
