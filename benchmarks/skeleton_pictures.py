"""Pictures of armatures inside the meshes that they were made for, and of one character posed with its own.

usage: python -m benchmarks.skeleton_pictures --data DIR --output DIR

Needs Blender as a Python module and matplotlib. Bodies are in the colours of their parts, bones drawn in front as
Blender draws them. What is not in DIR is left out.
"""

import argparse
import sys
from dataclasses import dataclass
from math import radians
from pathlib import Path

import numpy as np

from benchmarks.posed_families import read_mesh
from examples import humanoid, octopus
from tools.extension import load_extension

Z_UP, Y_UP = np.eye(3), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
LIGHT = np.array([0.35, 0.45, 0.85])
PAPER = np.array([0.955, 0.955, 0.955])


@dataclass(frozen=True)
class Subject:
    """A mesh to be shown: its file or None for an example, the turn that puts it upright, and the view."""

    name: str
    file: str | None
    upright: np.ndarray
    azimuth: float
    elevation: float


SUBJECTS = (
    Subject("humanoid", None, Z_UP, 20, 8),
    Subject("octopus", None, Z_UP, 20, 40),
    Subject("makehuman", "makehuman/mh_body_0_rest.obj", Y_UP, 25, 8),
    Subject("wolf", "quaternius-animals/wolf_0_rest.off", Y_UP, -60, 12),
    Subject("hand", "webxr-hand/hand_0_rest.off", Y_UP, 100, 10),
    Subject("camel", "cgal-data/camel.off", Y_UP, -60, 12),
)
EXAMPLES = {"humanoid": humanoid, "octopus": octopus}


def main() -> int:
    """Write the pictures."""
    import bpy

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    arguments = parser.parse_args()
    extension = load_extension()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    extension.register()
    shown = []
    for subject in SUBJECTS:
        mesh = _mesh_of(subject, arguments.data)
        if mesh is None:
            sys.stdout.write(f"Skipped: there is no {subject.file}.\n")
            continue
        obj, armature = _rigged(subject.name, *mesh)
        shown.append((subject, *_seen(obj, armature)))
        if subject.name == "humanoid":
            posed = (subject, *_seen(obj, _posed(armature)))
    _draw(shown, arguments.output / "skeleton_armatures.png", 3)
    _draw([shown[0], posed], arguments.output / "skeleton_posed.png", 2)
    return 0


def _mesh_of(subject: Subject, data: Path):
    if subject.file is None:
        character = EXAMPLES[subject.name]()
        return character.vertices, character.quads
    if not (data / subject.file).is_file():
        return None
    mesh = read_mesh(data / subject.file)
    vertices = mesh.vertices @ subject.upright.T
    return vertices / np.ptp(vertices, axis=0).max(), mesh.triangles


def _rigged(name: str, vertices, faces):
    import bpy

    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices.tolist(), [], faces.tolist())
    obj = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(obj)
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.create_armature()
    return obj, bpy.context.object


def _posed(armature):
    """Raise one arm, bend the other, lift a knee, turn the head and lean: each by the bones that lie there."""
    from mathutils import Matrix

    def turn(bone: str, degrees: float, axis: str) -> None:
        posed = armature.pose.bones[bone]
        at_rest = posed.bone.matrix_local
        pivot = Matrix.Translation(posed.bone.head_local)
        motion = pivot @ Matrix.Rotation(radians(degrees), 4, axis) @ pivot.inverted()
        posed.matrix_basis = at_rest.inverted() @ motion @ at_rest

    for joint, degrees, axis in (
        ((0.15, 0, 1.3), 55, "Y"),
        ((0.42, 0, 1.3), -50, "Z"),
        ((-0.15, 0, 1.3), -60, "Y"),
        ((-0.42, 0, 1.3), 70, "Z"),
        ((0.09, 0, 0.8), -70, "X"),
        ((0.1, 0, 0.43), 85, "X"),
        ((0, 0, 1.42), 25, "Z"),
        ((0, 0, 1.08), 14, "Y"),
    ):
        turn(_bone_at(armature, np.array(joint)), degrees, axis)
    return armature


def _bone_at(armature, place: np.ndarray) -> str:
    """Return the bone that begins nearest to a place and leads away from the body."""
    bones = [bone for bone in armature.data.bones if bone.parent and not bone.name.startswith("Root")]
    return min(bones, key=lambda bone: np.linalg.norm(np.array(bone.head_local) - place)).name


def _seen(obj, armature):
    """Return vertices, triangles, colours of triangles, heads, tails and colours of bones, as evaluated now."""
    import bpy

    bpy.context.view_layer.update()
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    vertices = np.array([vertex.co for vertex in evaluated.vertices])
    triangles = np.array([triangle.vertices for triangle in evaluated.loop_triangles])
    loops = np.array([triangle.loops[0] for triangle in evaluated.loop_triangles])
    colours = np.empty(4 * len(evaluated.loops), dtype=np.float32)
    evaluated.color_attributes["part_color"].data.foreach_get("color_srgb", colours)
    deforming = [bone for bone in armature.pose.bones if bone.bone.use_deform]
    heads, tails = (np.array([getattr(bone, end) for bone in deforming]) for end in ("head", "tail"))
    return vertices, triangles, colours.reshape(-1, 4)[loops, :3], heads, tails


def _draw(shown, path: Path, n_columns: int) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    n_rows = -(-len(shown) // n_columns)
    figure, axes = plt.subplots(n_rows, n_columns, figsize=(4.6 * n_columns, 4.6 * n_rows), squeeze=False)
    figure.patch.set_facecolor(PAPER)
    for axis in axes.ravel():
        axis.axis("off")
    for axis, (subject, *seen) in zip(axes.ravel(), shown, strict=False):
        _draw_one(axis, subject, *seen)
    figure.subplots_adjust(0.01, 0.01, 0.99, 0.99, 0.02, 0.02)
    figure.savefig(path, dpi=110)


def _draw_one(axis, subject: Subject, vertices, triangles, colours, heads, tails) -> None:
    from matplotlib.collections import PolyCollection

    turn = _view(subject)
    seen = vertices @ turn.T
    corners = seen[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    order = np.argsort(corners[:, :, 2].mean(axis=1))
    order = order[normals[order, 2] > 0]
    light = 0.55 + 0.45 * np.clip(normals @ (LIGHT / np.linalg.norm(LIGHT)), 0, 1)
    shade = np.clip((0.55 * colours + 0.45) * light[:, None], 0, 1)
    axis.add_collection(
        PolyCollection(corners[order][:, :, :2], facecolors=shade[order], edgecolors=shade[order], lw=0.3)
    )
    kites = [_kite(head, tail) for head, tail in zip(heads @ turn.T, tails @ turn.T, strict=True)]
    axis.add_collection(PolyCollection(kites, facecolors=(0.25, 0.27, 0.3, 0.75), edgecolors="black", lw=0.7))
    joints = np.concatenate([heads, tails]) @ turn.T
    axis.plot(joints[:, 0], joints[:, 1], "o", ms=2.6, color="white", mec="black", mew=0.6)
    axis.set_aspect("equal")
    axis.autoscale_view()


def _kite(head, tail) -> np.ndarray:
    """Return a bone as Blender draws it, thickest near its head."""
    head, tail = head[:2], tail[:2]
    across = np.array([head[1] - tail[1], tail[0] - head[0]]) * 0.1
    thick = head + 0.15 * (tail - head)
    return np.stack([head, thick + across, tail, thick - across])


def _view(subject: Subject) -> np.ndarray:
    """Return the rotation into a frame with x to the right, y up and z towards the eye."""
    azimuth, elevation = radians(subject.azimuth), radians(subject.elevation)
    right = np.array([np.cos(azimuth), np.sin(azimuth), 0])
    eye = np.array([np.sin(azimuth) * np.cos(elevation), -np.cos(azimuth) * np.cos(elevation), np.sin(elevation)])
    return np.stack([right, np.cross(eye, right), eye])


if __name__ == "__main__":
    raise SystemExit(main())
