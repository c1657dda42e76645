"""Give meshes back what they had if writing to them fails half way."""

from collections.abc import Iterator
from contextlib import contextmanager

import bmesh
import bpy
import numpy as np

from .exchange import OWN_ATTRIBUTES, own_names, remove_own_attributes
from .layers import STORAGES
from .state import STATE

# Fields of the rows that the panel lists.
LISTS = {"rows": ("part", "depth", "share", "n_faces"), "correction_rows": ("place", "title", "rests")}


@contextmanager
def all_or_nothing(*meshes: bpy.types.Mesh) -> Iterator[None]:
    """Write all that the block writes to analyzed meshes, or nothing of it if it raises anything.

    Vertex groups and materials keep their own record of what is ours, so these may stay as the block left them.
    """
    copies = [_copy(mesh) for mesh in meshes]
    try:
        yield
    except BaseException:
        for mesh, copy in zip(meshes, copies, strict=True):
            _restore(mesh, copy)
        raise
    finally:
        for copy in copies:
            bpy.data.meshes.remove(copy)


def _copy(mesh: bpy.types.Mesh) -> bpy.types.Mesh:
    copy = mesh.copy()
    # Outputs remove materials that nobody uses any more.
    for slot in range(len(copy.materials)):
        copy.materials[slot] = None
    return copy


def _restore(mesh: bpy.types.Mesh, copy: bpy.types.Mesh) -> None:
    if len(mesh.vertices) != len(copy.vertices) or len(mesh.polygons) != len(copy.polygons):
        _restore_faces(mesh, copy)
    remove_own_attributes(mesh, [name for name in own_names(mesh) if name not in own_names(copy)])
    for name in set(own_names(copy)) & set(copy.attributes.keys()):
        _restore_attribute(mesh, copy.attributes[name])
    for name in (STATE, OWN_ATTRIBUTES):
        _restore_property(mesh, copy, name)
    # Newer versions keep the name of an active layer that is gone.
    mesh.color_attributes.active_color_name = copy.color_attributes.active_color_name
    for name, fields in LISTS.items():
        if hasattr(mesh, "eigenparts"):
            _restore_list(getattr(mesh.eigenparts, name), getattr(copy.eigenparts, name), fields)
    mesh.update()


def _restore_faces(mesh: bpy.types.Mesh, copy: bpy.types.Mesh) -> None:
    edited = bmesh.new()
    edited.from_mesh(copy)
    edited.to_mesh(mesh)
    edited.free()


def _restore_attribute(mesh: bpy.types.Mesh, kept: bpy.types.Attribute) -> None:
    present = mesh.attributes.get(kept.name)
    if present is not None and (present.data_type, present.domain) != (kept.data_type, kept.domain):
        mesh.attributes.remove(present)
    if kept.name not in mesh.attributes:
        mesh.attributes.new(kept.name, type=kept.data_type, domain=kept.domain)
    storage = STORAGES[kept.data_type]
    values = np.empty(storage.n_components * len(kept.data), dtype=storage.dtype)
    kept.data.foreach_get(storage.property_name, values)
    mesh.attributes[kept.name].data.foreach_set(storage.property_name, values)


def _restore_property(mesh: bpy.types.Mesh, copy: bpy.types.Mesh, name: str) -> None:
    if name in mesh:
        del mesh[name]
    if name in copy:
        mesh[name] = copy[name].to_dict() if hasattr(copy[name], "to_dict") else copy[name]


def _restore_list(
    rows: bpy.types.bpy_prop_collection, kept: bpy.types.bpy_prop_collection, fields: tuple[str, ...]
) -> None:
    rows.clear()
    for one in kept:
        row = rows.add()
        for name in fields:
            setattr(row, name, getattr(one, name))
