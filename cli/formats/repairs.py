"""Meshes that a file did not give as they should be: mended, counted and told."""

from __future__ import annotations

from collections import defaultdict

import bpy
import numpy as np
from numpy.typing import NDArray

from ...operators.mesh_data.mesh_arrays import read_edges, read_positions
from ...tasks.refusals import Refusal

# Sentences about the meshes of a file by their names; those about the file as a whole have none.
Repairs = dict[str, list[str]]
WHOLE_FILE = ""
MOVED = (
    "Points that are no numbers in the file: {}; each was put in the middle of its neighbours, or at the origin if it"
    " has none."
)
NO_NUMBERS = "the mesh {!r} has points that are no numbers ({}); repair the file in the program that wrote it."
FEWER_FACES = (
    "The file lists {} faces and the mesh has {}: those that repeat a corner or another face, or name points that do"
    " not exist, were left out or divided."
)
MORE_FACES = (
    "The file lists {} faces and the mesh has {}: Blender divided some of them, or took something else for faces; look"
    " whether the mesh is as it should be."
)


def mended(n_listed_faces: int | None = None, not_finite: NDArray[np.bool_] | None = None) -> Repairs:
    """Mend all meshes that are open, and return what was done.

    Parameters
    ----------
    n_listed_faces : int, optional
        Faces of all meshes as the file has them.
    not_finite : (V,) bool, optional
        The points that are no numbers, where the importer of a file with one mesh hides them.
    """
    repairs: Repairs = defaultdict(list)
    n_listed = _n_faces() if n_listed_faces is None else n_listed_faces
    for mesh in bpy.data.meshes:
        n_moved = move_to_neighbours(mesh, not_finite)
        if n_moved:
            repairs[mesh.name].append(MOVED.format(n_moved))
        # Custom normals are only kept this way.
        mesh.validate(clean_customdata=False)
    if _n_faces() != n_listed:
        repairs[WHOLE_FILE].append(other_faces(n_listed, _n_faces()))
    return repairs


def other_faces(n_listed: int, n_faces: int) -> str:
    """Return the sentence about a mesh that has fewer or more faces than its file lists."""
    return (FEWER_FACES if n_faces < n_listed else MORE_FACES).format(n_listed, n_faces)


def move_to_neighbours(mesh: bpy.types.Mesh, not_finite: NDArray[np.bool_] | None = None) -> int:
    """Put points that are no numbers in the middle of their neighbours, and return how many there are."""
    places = read_positions(mesh)
    is_lost = ~np.isfinite(places).all(axis=1)
    if not_finite is not None and len(not_finite) == len(is_lost):
        is_lost |= not_finite
    if is_lost.any():
        mesh.vertices.foreach_set("co", _filled(places, is_lost, read_edges(mesh)).ravel())
        mesh.update()
    return int(is_lost.sum())


def refuse_no_numbers(counts: dict[str, int]) -> None:
    """Raise a Refusal if a mesh has points that are no numbers, in a format that cannot be mended."""
    for name, count in counts.items():
        if count:
            raise Refusal(NO_NUMBERS.format(name, count))


def _filled(places: NDArray[np.float32], is_lost: NDArray[np.bool_], edges: NDArray[np.int64]) -> NDArray[np.float32]:
    """Return the places with those that are lost filled in from the ones beside them, inwards from the rim."""
    places = np.where(is_lost[:, None], 0, places).astype(np.float32)
    is_lost = is_lost.copy()
    tails, heads = np.concatenate([edges, edges[:, ::-1]]).T
    while True:
        is_used = is_lost[tails] & ~is_lost[heads]
        if not is_used.any():
            return places
        counts = np.bincount(tails[is_used], minlength=len(places))
        sums = np.stack(
            [np.bincount(tails[is_used], column, len(places)) for column in places[heads[is_used]].T], axis=1
        )
        places[counts > 0] = (sums[counts > 0] / counts[counts > 0, None]).astype(np.float32)
        is_lost[counts > 0] = False


def _n_faces() -> int:
    return sum(len(mesh.polygons) for mesh in bpy.data.meshes)
