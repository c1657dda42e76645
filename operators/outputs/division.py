"""What a mesh is divided into, as outputs need it."""

from dataclasses import dataclass

import numpy as np

from ..mesh_data.mesh_arrays import OwnAttribute

# The face map.
PART = OwnAttribute("part", "INT", "FACE")


@dataclass(frozen=True, eq=False)
class Division:
    """The parts of a mesh with F faces.

    Attributes
    ----------
    labels : (F,) int32
        Part of each face, 0 for the body.
    names : dict
        The name of each part that has faces, by its number.
    colours : (n, 4) float32
        Linear RGBA of each number up to the highest.
    softness : float
        Width in the mesh's unit over which vertex groups pass from one part to the next; 0 for hard borders.
    """

    labels: np.ndarray
    names: dict[int, str]
    colours: np.ndarray
    softness: float = 0.0
