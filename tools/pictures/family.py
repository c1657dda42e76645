"""A registered family: a character takes poses, each a mesh of its own, and its parts keep their colours."""

import sys
from pathlib import Path

import bpy
import numpy as np

from eigenparts.compute import TriangleMesh, analyze
from eigenparts.compute.registration.parts.population import Reference, prepare_reference, register_one
from eigenparts.compute.surface.mesh import Ints
from eigenparts.operators.blender.known_values import mesh_of, present
from examples import Character, humanoid, humanoid_poses
from tools.pictures.characters import Coarse, add_mesh, between, coarsened, paint_faces, standing, triangle_mesh
from tools.pictures.moving import Frame, write_gif
from tools.pictures.shots import shot
from tools.render import View, world_positions

POSES = ("walk", "wave", "arms_up", "sit", "reach")
# Frames from one pose to the next; each costs a registration.
N_BETWEEN = 3
STEP_TIME, REST_TIME = 160, 900
# The one whose parts all have, at rest, and the one that is shown, each with a triangulation of its own.
N_REFERENCE, N_SHOWN = 6000, 8000
# The coarse one beside it has this share of the faces.
COARSE = 0.4
SPACING = 1.6
WIDTH, HEIGHT = 640, 440


def draw(target: Path) -> None:
    """Write the moving picture."""
    rest = humanoid(N_REFERENCE)
    shown, few = humanoid(N_SHOWN), coarsened(rest, COARSE)
    fine, coarse = _moved(shown, shown.triangles), _moved(few, few.faces)
    analysis = analyze(TriangleMesh(rest.vertices, rest.triangles))
    reference = prepare_reference(analysis, analysis.segment(mode="nested"))
    confidence = [_take_parts(reference, obj) for obj in (*fine, *coarse)]
    sys.stdout.write(f"Least confidence of {len(confidence)} meshes: {min(confidence):.2f}\n")
    sys.stdout.flush()
    for obj in coarse:
        mesh_of(obj).shade_flat()
        obj.location.x += SPACING
    write_gif(_frames(fine, coarse), target)


def _take_parts(reference: Reference, obj: bpy.types.Object) -> float:
    """Paint an object in the parts of the reference; return how sure the matching is, from 0 to 1."""
    found = register_one(reference, analyze(triangle_mesh(obj)))
    paint_faces(obj, found.segmentation.labels)
    return found.matching.confidence


def _frames(fine: list[bpy.types.Object], coarse: list[bpy.types.Object]) -> list[Frame]:
    """Return a picture of each pair, all from the same place."""
    present(bpy.context.view_layer).update()
    framed = np.concatenate([world_positions(obj) for obj in (*fine, *coarse)])
    view = View(azimuth=16, width=WIDTH, height=HEIGHT, samples=12, framed=framed)
    frames = []
    for number, pair in enumerate(zip(fine, coarse, strict=True)):
        frames.append(Frame(shot(pair, view), STEP_TIME if number % (N_BETWEEN + 1) else REST_TIME))
    return frames


def _moved(character: Character | Coarse, faces: Ints) -> list[bpy.types.Object]:
    """Return a mesh for each frame, from pose to pose and back to the first."""
    poses = [humanoid_poses.POSES[name] for name in POSES]
    shares = np.linspace(0, 1, N_BETWEEN + 1, endpoint=False)
    # Slow at the ends, as whoever moves is.
    eased = (1 - np.cos(np.pi * shares)) / 2
    return [
        add_mesh("Frame", standing(character, between(start, end, float(share))), faces)
        for start, end in zip(poses, [*poses[1:], poses[0]], strict=True)
        for share in eased
    ]
