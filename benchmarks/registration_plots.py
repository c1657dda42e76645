"""Contact sheets of registered poses: ``python -m benchmarks.registration_plots --output DIR [--data DIR]``.

Every pose has a triangulation of its own; equal colour means equal part. With a folder of meshes the posed families in
it are drawn too, remeshed, one sheet each.
"""

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.collections import PolyCollection
from scipy.spatial.transform import Rotation

from benchmarks.posed_families import FAMILIES, load_family, remeshed, shuffled
from compute.analysis import analyze
from compute.mesh import Floats, Ints, TriangleMesh
from compute.registration.population import prepare_reference, register_one
from examples import hand, humanoid, octopus, quadruped

# Each character with the sizes that its poses are made in, how far it is turned about the vertical, and whether it is
# looked at from above.
CHARACTERS = (
    (humanoid, (5000, 4000, 6000, 4500, 5500), 0, 0),
    (quadruped, (4000, 3000, 5000, 3500, 4500), 60, 0),
    (hand, (3000, 2500, 3500, 4000, 2800), -20, 70),
    (octopus, (5000, 4000, 6000, 4500), 20, 35),
)
LIGHT = np.array([0.3, -0.8, 0.6]) / np.linalg.norm([0.3, -0.8, 0.6])
BODY_COLOUR = (0.82, 0.82, 0.82)
COLOURS = mpl.colormaps["tab20"](np.r_[0:20:2, 1:20:2])[:, :3]


@dataclass(frozen=True, eq=False)
class Picture:
    """A mesh with the part of each triangle; T triangles."""

    title: str
    mesh: TriangleMesh
    labels: Ints


def registered_poses(meshes: dict[str, TriangleMesh]) -> Iterator[Picture]:
    """Yield the poses in the parts of the first one."""
    (first, mesh), *others = meshes.items()
    analysis = analyze(mesh)
    own = analysis.segment(mode="nested")
    reference = prepare_reference(analysis, own)
    yield Picture(f"{first}, reference", mesh, own.labels)
    for name, other in others:
        found = register_one(reference, analyze(other))
        yield Picture(f"{name}, {found.matching.confidence:.2f}", other, found.segmentation.labels)


def view_of(turn: float, tilt: float) -> Floats:
    """Return the rotation after which one looks along y: a turn about z, then a tilt towards the view, in degrees."""
    around = Rotation.from_euler("z", turn, degrees=True)
    return (Rotation.from_euler("x", tilt, degrees=True) * around).as_matrix()


def draw_row(axes: list, pictures: list[Picture], view: Floats) -> None:
    """Draw pictures side by side, looked at along y after a rotation."""
    for axis in axes:
        axis.set_axis_off()
    for axis, picture in zip(axes, pictures, strict=False):
        _draw(axis, picture, view)


def _draw(axis, picture: Picture, view: Floats) -> None:
    corners = (picture.mesh.vertices @ view.T)[picture.mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-30)[:, None]
    colours = np.where(picture.labels[:, None] > 0, COLOURS[(picture.labels - 1) % len(COLOURS)], np.array(BODY_COLOUR))
    shaded = colours * (0.55 + 0.45 * np.clip(normals @ LIGHT, 0, 1))[:, None]
    order = np.argsort(-corners[:, :, 1].mean(axis=1))
    axis.add_collection(PolyCollection(corners[order][:, :, [0, 2]], facecolors=shaded[order], linewidths=0))
    axis.autoscale_view()
    axis.set_aspect("equal")
    axis.set_title(picture.title, fontsize=7)


def save_sheet(path: Path, rows: list[tuple[list[Picture], Floats]]) -> None:
    """Write a picture of rows of poses, each with its view."""
    n_columns = max(len(pictures) for pictures, _ in rows)
    figure, axes = plt.subplots(len(rows), n_columns, figsize=(1.5 * n_columns, 1.7 * len(rows)), squeeze=False)
    for row, (pictures, view) in zip(axes, rows, strict=True):
        draw_row(list(row), pictures, view)
    figure.subplots_adjust(0, 0, 1, 0.95, 0.02, 0.15)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def characters() -> Iterator[tuple[list[Picture], Floats]]:
    """Yield a row for each character made by code."""
    for make, sizes, turn, tilt in CHARACTERS:
        made = [make(size) for size in sizes]
        poses = list(made[0].poses)[: len(sizes)]
        meshes = {
            pose: shuffled(TriangleMesh(one.mesh_in_pose(pose), one.triangles))
            for pose, one in zip(poses, made, strict=True)
        }
        yield list(registered_poses(meshes)), view_of(turn, tilt)


def families(data: Path) -> Iterator[tuple[str, list[Picture]]]:
    """Yield the posed families that are there, remeshed; y is up in their files."""
    for name in FAMILIES:
        poses = load_family(data, name)
        upright = {
            pose.name: TriangleMesh(
                pose.mesh.vertices @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), pose.mesh.triangles
            )
            for pose in poses
        }
        meshes = {
            pose: mesh if number == 0 else remeshed(mesh, 3000) for number, (pose, mesh) in enumerate(upright.items())
        }
        if meshes:
            yield name, list(registered_poses(meshes))


def main() -> None:
    """Write the sheets."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--data", type=Path)
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    save_sheet(arguments.output / "registration.png", list(characters()))
    for name, pictures in families(arguments.data) if arguments.data else ():
        save_sheet(arguments.output / f"registration_{name}.png", [(pictures, view_of(40, 0))])


if __name__ == "__main__":
    main()
