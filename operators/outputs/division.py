"""The division of a mesh into parts, as outputs need it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh_data.mesh_arrays import OwnAttribute
from ..mesh_state.part_table import PartTable

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
        Width in the unit of the world over which vertex groups pass from one part to the next; 0 for hard borders.
    """

    labels: NDArray[np.int32]
    names: dict[int, str]
    colours: NDArray[np.float32]
    softness: float = 0.0


def division_of(labels: NDArray[np.int32], parts: PartTable, softness: float) -> Division:
    """Return the division for the parts (F,) of the faces, with what they are called and their colours."""
    present = np.flatnonzero(np.bincount(labels))
    names = {part: parts.name_of(part) for part in present.tolist()}
    return Division(labels, names, parts.colours_of(int(labels.max(initial=0)) + 1), softness)
