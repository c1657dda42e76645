"""Output: a vertex group for each part, with hard borders or softened over a width on the surface."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ..mesh_data.mesh_arrays import read_mesh
from ..mesh_data.world_shape import size_of, users_of
from ..mesh_state.state import read
from .division import Division
from .output import Output
from .vertex_map import labels_of_vertices

# On the mesh: the name of the group of each part.
OWN_GROUPS = "eigenparts_groups"


def write(mesh: bpy.types.Mesh, division: Division) -> None:
    """Write the groups, named after the parts; the weights of each vertex add up to 1."""
    obj = _object_of(mesh)
    if obj is None:
        # Groups belong to objects; they come as soon as one uses the mesh and the level moves.
        return
    groups = _groups(mesh, obj, division.names)
    labels = labels_of_vertices(mesh, division.labels)
    if division.softness > 0:
        _fill_softly(groups, *_softened(mesh, labels, division.softness / (size_of(obj) or 1.0)))
    else:
        _fill_hard(groups, labels)


def remove(mesh: bpy.types.Mesh) -> None:
    """Take the groups back."""
    obj = _object_of(mesh)
    if obj is not None:
        _drop(obj, _own_groups(mesh).values())
    if mesh.get(OWN_GROUPS) is not None:
        del mesh[OWN_GROUPS]


def all_names(mesh: bpy.types.Mesh) -> tuple[str, ...]:
    """Return the names of all groups that the mesh has, of whoever."""
    obj = _object_of(mesh)
    return () if obj is None else tuple(group.name for group in obj.vertex_groups)


def keep_only(mesh: bpy.types.Mesh, names: tuple[str, ...]) -> None:
    """Remove all groups that have other names."""
    obj = _object_of(mesh)
    if obj is not None:
        _drop(obj, [name for name in all_names(mesh) if name not in names])


def _object_of(mesh: bpy.types.Mesh) -> bpy.types.Object | None:
    """Return an object that uses the mesh; all that do share its groups."""
    return next(iter(users_of(mesh)), None)


def _own_groups(mesh: bpy.types.Mesh) -> dict[int, str]:
    stored = mesh.get(OWN_GROUPS)
    if not hasattr(stored, "to_dict"):
        return {}
    return {int(part): stored[part] for part in stored if part.isdecimal() and isinstance(stored[part], str)}


def _groups(mesh: bpy.types.Mesh, obj: bpy.types.Object, names: dict[int, str]) -> dict[int, bpy.types.VertexGroup]:
    """Return an empty group for each part; those of parts that are gone are removed."""
    with active_group_kept(obj):
        _drop(obj, _own_groups(mesh).values())
        # Where the user has a group of that name, Blender gives ours a number.
        groups = {part: obj.vertex_groups.new(name=name) for part, name in names.items()}
    mesh[OWN_GROUPS] = {str(part): group.name for part, group in groups.items()}
    # New groups may have moved in memory while others were added.
    return {part: obj.vertex_groups[name] for part, name in _own_groups(mesh).items()}


def _drop(obj: bpy.types.Object, names: Iterable[str]) -> None:
    with active_group_kept(obj):
        for name in names:
            if name in obj.vertex_groups:
                obj.vertex_groups.remove(obj.vertex_groups[name])


@contextmanager
def active_group_kept(obj: bpy.types.Object) -> Iterator[None]:
    """Leave the group active that was, if it is still there: Blender takes the one that was added last."""
    active = obj.vertex_groups.active
    active_name = active.name if active else ""
    yield
    if active_name in obj.vertex_groups:
        obj.vertex_groups.active = obj.vertex_groups[active_name]


def _fill_hard(groups: dict[int, bpy.types.VertexGroup], labels: NDArray[np.int32]) -> None:
    for part, group in groups.items():
        group.add(np.flatnonzero(labels == part).tolist(), 1.0, "REPLACE")


def _fill_softly(
    groups: dict[int, bpy.types.VertexGroup], parts: NDArray[np.int64], weights: NDArray[np.float64]
) -> None:
    for part, column in zip(parts.tolist(), weights.T, strict=True):
        if part not in groups:
            continue
        groups[part].add(np.flatnonzero(column == 1).tolist(), 1.0, "REPLACE")
        # Blender takes one weight for any number of vertices, so the few between two parts go one by one.
        for vertex in np.flatnonzero((column > 0) & (column < 1)).tolist():
            groups[part].add([vertex], column[vertex], "REPLACE")


def _softened(
    mesh: bpy.types.Mesh, labels: NDArray[np.int32], width: float
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return the parts (P,) and the (V, P) weights; vertices at one place get the same."""
    arrays = read_mesh(mesh, read(mesh).stretch)
    _, first, place = np.unique(arrays.vertices, axis=0, return_index=True, return_inverse=True)
    place = place.reshape(-1)
    welded = compute.TriangleMesh(arrays.vertices[first], place[arrays.triangles])
    parts, weights = compute.softened_labels(welded, labels[first], width)
    return parts, weights[place]


OUTPUT = Output(
    "VERTEX_GROUPS",
    "Vertex Groups",
    "A vertex group for each part, of its name",
    (),
    write,
    remove,
    is_compound=True,
    options=("softness",),
)
