"""Meshes that are not part of the project, from a folder that is laid out as the benchmarks want it."""

from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from benchmarks.posed_families import read_mesh
from tools.pictures.characters import add_mesh
from tools.pictures.gallery import CELL
from tools.render import View

# Files in which y is up.
Y_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])


@dataclass(frozen=True)
class Mesh:
    """A file and from where it is seen, in degrees."""

    file: str
    azimuth: float
    elevation: float

    @property
    def view(self) -> View:
        """From where it is seen."""
        return View(self.azimuth, self.elevation, *CELL)


MESHES = {
    "makehuman": Mesh("makehuman/mh_body_0_rest.obj", 25, 8),
    "wolf": Mesh("quaternius-animals/wolf_0_rest.off", -60, 12),
    "horse": Mesh("quaternius-animals/horse_0_rest.off", -60, 12),
    "trex": Mesh("quaternius-dinosaurs/trex_0_rest.off", -60, 12),
    "hand": Mesh("webxr-hand/hand_0_rest.off", 100, 10),
    "camel": Mesh("cgal-data/camel.off", -60, 12),
}


def added(mesh: Mesh, data: Path) -> bpy.types.Object:
    """Add a mesh upright on the ground, its largest extent 1."""
    read = read_mesh(data / mesh.file)
    return add_mesh(Path(mesh.file).stem, upright(read.vertices), read.triangles)


def upright(vertices: np.ndarray) -> np.ndarray:
    """Return vertices with z up, on the ground, their largest extent 1."""
    turned = vertices @ Y_UP.T
    turned = turned / np.ptp(turned, axis=0).max()
    return turned - [0, 0, turned[:, 2].min()]
