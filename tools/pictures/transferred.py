"""Labels and weights of one mesh, and what other poses with other triangulations get of them."""

from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from benchmarks.posed_families import read_mesh
from eigenparts.compute import Correspondence, TriangleMesh, analyze, correspond
from eigenparts.compute.surface.mesh import Floats
from eigenparts.operators.blender.known_values import mesh_of
from examples import Character, humanoid
from tools.pictures.characters import add_mesh, paint, paint_faces, standing
from tools.pictures.lettering import sheet
from tools.pictures.shots import shot
from tools.render import View

# Poses with the number of vertices that each has, the source first.
POSES = {"rest": 10000, "walk": 7000, "sit": 12000, "reach": 8500}
# Bones whose weights are shown together, and linear RGB of no and full weight.
BONES = ("upper_arm.L", "upper_arm.R", "thigh.L", "thigh.R", "spine")
NONE, FULL = np.array([0.6, 0.63, 0.68, 1.0]), np.array([0.7, 0.03, 0.03, 1.0])
# Numbers of the vertices or faces of a mesh.
Values = NDArray[Any]
# Files in which y is up.
Y_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
FOX, WOLF = "khronos-fox/fox_0_rest.off", "quaternius-animals/wolf_0_rest.off"


def draw_labels(target: Path) -> None:
    """Write the true parts of a character, and what its poses get."""
    parts = _characters()["rest"].fine_part_of_quad.repeat(2)
    carried = [parts, *(found.transfer_faces(parts) for found in _found())]
    _draw(target, posed(), carried, paint_faces, titles())


def draw_weights(target: Path) -> None:
    """Write the weights of some bones together, and what the poses get."""
    _draw(target, posed(), carried_weights(), paint_values, titles())


def draw_kin(target: Path, data: Path) -> None:
    """Write the parts of a fox, and what a wolf gets."""
    fox, wolf = (_upright(read_mesh(data / name)) for name in (FOX, WOLF))
    analysis = analyze(fox)
    parts = analysis.segment(mode="nested").labels
    carried = [parts, correspond(analysis, analyze(wolf)).transfer_faces(parts)]
    _draw(target, [fox, wolf], carried, paint_faces, ["fox", "wolf"], View(-60, 12, 450, 340))


def carried_weights() -> list[Values]:
    """Return the weights of some bones together, of the first character and as the poses get them."""
    source = _characters()["rest"]
    shown = [number for number, bone in enumerate(source.bones) if bone.name in BONES]
    weights = source.weights[:, shown].sum(axis=1)
    return [weights, *(found.transfer(weights) for found in _found())]


@cache
def posed() -> list[TriangleMesh]:
    """Return the meshes, each in its pose and with its own triangulation."""
    return [TriangleMesh(standing(one, one.poses[pose]), one.triangles) for pose, one in _characters().items()]


def titles() -> list[str]:
    """Return what each mesh is."""
    return [f"{pose}, {n_vertices:,} vertices" for pose, n_vertices in POSES.items()]


def paint_values(obj: bpy.types.Object, values: Floats) -> None:
    """Give an object the colours of values from 0 to 1 at its vertices."""
    corners = np.array([face.vertices for face in mesh_of(obj).polygons]).ravel()
    share = np.clip(values[corners], 0, 1)[:, None]
    paint(obj, (1 - share) * NONE + share * FULL)


@cache
def _characters() -> dict[str, Character]:
    return {pose: humanoid(n_vertices) for pose, n_vertices in POSES.items()}


@cache
def _found() -> list[Correspondence]:
    source, *others = (analyze(mesh) for mesh in posed())
    return [correspond(source, other) for other in others]


def _upright(mesh: TriangleMesh) -> TriangleMesh:
    """Return a mesh with z up, on the ground, its largest extent 1."""
    turned = mesh.vertices @ Y_UP.T
    turned = turned / np.ptp(turned, axis=0).max()
    return TriangleMesh(turned - [0, 0, turned[:, 2].min()], mesh.triangles)


def _draw(
    target: Path,
    meshes: Sequence[TriangleMesh],
    carried: Sequence[Values],
    paint_object: Callable[[bpy.types.Object, Values], None],
    titles: Sequence[str],
    view: View | None = None,
) -> None:
    """Write meshes side by side with what they carry."""
    view = view or View(azimuth=18, elevation=8, width=320, height=350)
    images = []
    for mesh, values in zip(meshes, carried, strict=True):
        obj = add_mesh("Mesh", mesh.vertices, mesh.triangles)
        paint_object(obj, values)
        images.append(shot([obj], view))
    sheet([images], titles=[titles]).save(target)
