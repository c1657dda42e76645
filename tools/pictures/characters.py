"""Characters of the examples as objects: posed, analyzed by the operators that a user has, painted."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from eigenparts.compute import TriangleMesh
from eigenparts.compute.surface.mesh import Floats, Ints
from eigenparts.operators.blender.known_values import elements_of, mesh_of, present
from eigenparts.operators.mesh_state import palette
from eigenparts.operators.mesh_state.state import read
from examples import Bone, Character, Pose
from examples.rig import bone_motions
from examples.skinning import blend_skinning
from tools.extension_operators import run_operator

# Turns the hand so that its fingers point up and its palm along +x.
FINGERS_UP = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])


def add_mesh(name: str, vertices: Floats, faces: Ints) -> bpy.types.Object:
    """Add a mesh to the current collection, shaded smooth, and return its object."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices.tolist(), [], faces.tolist())
    data.shade_smooth()
    obj = bpy.data.objects.new(name, data)
    present(bpy.context.collection).objects.link(obj)
    return obj


@dataclass(frozen=True, eq=False)
class Coarse:
    """A character with few triangles.

    Attributes
    ----------
    bones : tuple of B Bone
    vertices : (V, 3) float64
        At rest.
    faces : (T, 3) int64
    weights : (V, B) float64
    """

    bones: tuple[Bone, ...]
    vertices: Floats
    faces: Ints
    weights: Floats


def coarsened(character: Character, share: float) -> Coarse:
    """Return a character with a share of its triangles, decimated by Blender at rest."""
    obj = add_mesh(character.name, character.vertices, character.quads)
    decimation = obj.modifiers.new("Decimate", "DECIMATE")
    assert isinstance(decimation, bpy.types.DecimateModifier)
    decimation.ratio = share
    mesh = mesh_of(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    vertices = np.array([vertex.co for vertex in mesh.vertices])
    faces = np.array([triangle.vertices for triangle in mesh.loop_triangles])
    bpy.data.objects.remove(obj)
    _, nearest = cKDTree(character.vertices).query(vertices)
    return Coarse(character.bones, vertices, faces, character.weights[nearest])


def standing(character: Character | Coarse, pose: Pose) -> Floats:
    """Return the vertices of a character in a pose, moved up or down so that it stands on the ground."""
    vertices = blend_skinning(character.vertices, character.weights, bone_motions(character.bones, pose))
    return vertices - [0, 0, vertices[:, 2].min()]


def between(start: Pose, end: Pose, share: float) -> Pose:
    """Return the pose that lies a share of the way from one pose to another."""
    bones = start.angles.keys() | end.angles.keys()
    still = (0.0, 0.0, 0.0)
    angles = {bone: _mean(start.angles.get(bone, still), end.angles.get(bone, still), share) for bone in bones}
    return Pose(angles, _mean(start.shift, end.shift, share))


def analyze(obj: bpy.types.Object) -> None:
    """Analyze an object; it shows its default level."""
    select([obj])
    run_operator("analyze")


def segment(obj: bpy.types.Object, **choice: float) -> None:
    """Divide an analyzed object anew."""
    select([obj])
    run_operator("segment", **choice)


def level_of(obj: bpy.types.Object) -> tuple[int, int, int]:
    """Return the level that an object shows, how many there are, and how many parts it shows."""
    summary = read(mesh_of(obj)).summary
    return summary.level, summary.n_levels, len(summary.parts)


def triangle_mesh(obj: bpy.types.Object) -> TriangleMesh:
    """Return the mesh of an object that has only triangles."""
    mesh = mesh_of(obj)
    vertices = np.array([vertex.co for vertex in mesh.vertices], dtype=np.float64)
    return TriangleMesh(vertices, np.array([face.vertices for face in mesh.polygons]))


def paint(obj: bpy.types.Object, colours: NDArray[np.floating[Any]]) -> None:
    """Give an object colours, linear RGBA, one for each corner of its faces."""
    layer = mesh_of(obj).color_attributes.new("part_color", "FLOAT_COLOR", "CORNER")
    elements_of(layer).foreach_set("color", colours.astype(np.float32).ravel())


def paint_faces(obj: bpy.types.Object, labels: NDArray[np.integer[Any]]) -> None:
    """Give the triangles of an object the colours of parts."""
    paint(obj, palette.colours_of_labels(int(labels.max()) + 1)[labels].repeat(3, axis=0))


def select(objects: Sequence[bpy.types.Object]) -> None:
    """Select some objects and nothing else; the last is the active one."""
    view_layer = present(bpy.context.view_layer)
    view_layer.update()
    for obj in list(view_layer.objects):
        obj.select_set(obj in objects)
    view_layer.objects.active = objects[-1]


def _mean(start: Sequence[float], end: Sequence[float], share: float) -> tuple[float, float, float]:
    x, y, z = ((1 - share) * a + share * b for a, b in zip(start, end, strict=True))
    return (x, y, z)
