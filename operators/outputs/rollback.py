"""Give meshes and objects back what they had if writing to them fails half way."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.attribute_types import STORAGES, AttributeType, Domain, Values
from ..blender.known_values import present
from ..blender.registered_settings import mesh_settings
from ..mesh_data.attribute_values import kind_of, read_attribute, store_values
from ..mesh_data.mesh_arrays import own_names, remove_own_attributes
from ..mesh_state.schema import MOST_LABELS
from ..mesh_state.state import is_analyzed, read
from ..mesh_state.validation import lie_within
from . import material_slots, output_registry, vertex_groups
from .division import PART, division_of

# Custom properties that are ours begin so.
OWN_PROPERTIES = "eigenparts_"
# Fields of the rows that the panel lists.
LISTS = {"rows": ("part", "depth", "share", "n_faces"), "correction_rows": ("place", "title", "rests")}
# Where data-blocks are that operators make.
MAKES = ("objects", "meshes", "armatures", "curves", "collections", "materials", "images")


@contextmanager
def all_or_nothing(*meshes: bpy.types.Mesh) -> Iterator[None]:
    """Write all that the block writes to meshes of what is ours, or nothing of it if it raises anything.

    Faces are not given back; see `faces_or_nothing`.
    """
    kept = [_Kept.of(mesh) for mesh in meshes]
    try:
        yield
    except BaseException:
        for mesh, before in zip(meshes, kept, strict=True):
            before.restore(mesh)
        raise


@contextmanager
def faces_or_nothing(mesh: bpy.types.Mesh) -> Iterator[None]:
    """Change the faces of a mesh, or leave them with all that they carry if the block raises anything."""
    copy = present(mesh.copy())
    try:
        yield
    except BaseException:
        edited = bmesh.new()
        edited.from_mesh(copy)
        edited.to_mesh(mesh)
        edited.free()
        # Blender 5 gives a mesh with UV maps a selection of them on this way.
        for name in set(mesh.attributes.keys()) - set(copy.attributes.keys()):
            mesh.attributes.remove(mesh.attributes[name])
        raise
    finally:
        bpy.data.meshes.remove(copy)


@contextmanager
def nothing_left_behind(context: bpy.types.Context) -> Iterator[None]:
    """Remove the data-blocks that the block has made if it raises anything, and select what was selected."""
    before = {block.session_uid for block in _blocks()}
    active, selected = present(context.view_layer).objects.active, list(context.selected_objects)
    try:
        yield
    except BaseException:
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.batch_remove([block for block in _blocks() if block.session_uid not in before])
        present(context.view_layer).objects.active = active
        for obj in list(present(context.view_layer).objects):
            obj.select_set(obj in selected)
        raise


@contextmanager
def bound_or_not(obj: bpy.types.Object) -> Iterator[None]:
    """Give an object a parent and modifiers, or leave it where it was if the block raises anything."""
    parent = obj.parent, obj.parent_type, obj.parent_bone, obj.matrix_parent_inverse.copy()
    before = [modifier.name for modifier in obj.modifiers]
    try:
        yield
    except BaseException:
        obj.parent, obj.parent_type, obj.parent_bone, obj.matrix_parent_inverse = parent
        for modifier in [modifier for modifier in obj.modifiers if modifier.name not in before]:
            obj.modifiers.remove(modifier)
        raise


def _blocks() -> Iterator[bpy.types.ID]:
    for name in MAKES:
        yield from getattr(bpy.data, name)


@dataclass(frozen=True, eq=False)
class _Kept:
    """All that a mesh has of ours, and the places it has among what is the user's.

    Attributes
    ----------
    attributes : dict
        Type, domain and values of our attributes and of the slots of the faces, by name.
    properties : dict
        Our custom properties as plain values.
    rows : dict
        The lists of the panel, a tuple for each row.
    active_colour : str
    slots : list
        The slots for materials.
    groups : tuple of str
        All vertex groups.
    """

    attributes: dict[str, tuple[AttributeType, Domain, Values]]
    properties: dict[str, Any]
    rows: dict[str, list[tuple[Any, ...]]]
    active_colour: str
    slots: list[material_slots.Slot]
    groups: tuple[str, ...]

    @classmethod
    def of(cls, mesh: bpy.types.Mesh) -> "_Kept":
        names = {*own_names(mesh), material_slots.MATERIAL_INDEX}
        existing = [attribute for attribute in mesh.attributes if attribute.name in names]
        return cls(
            {
                attribute.name: (*kind_of(attribute), read_attribute(attribute))
                for attribute in existing
                if attribute.data_type in STORAGES
            },
            {name: _plain(mesh[name]) for name in _own_properties(mesh)},
            {name: _rows(mesh, name, fields) for name, fields in LISTS.items()},
            mesh.color_attributes.active_color_name or "",
            material_slots.slots_of(mesh),
            vertex_groups.all_names(mesh),
        )

    def restore(self, mesh: bpy.types.Mesh) -> None:
        """Give a mesh what it had; outputs that are no attributes are made anew from it."""
        vertex_groups.keep_only(mesh, self.groups)
        material_slots.restore(mesh, self.slots)
        remove_own_attributes(mesh, [name for name in own_names(mesh) if name not in self.attributes])
        if material_slots.MATERIAL_INDEX not in self.attributes:
            material_slots.forget_assignment(mesh)
        for name, kept in self.attributes.items():
            _restore_attribute(mesh, name, *kept)
        for name in {*_own_properties(mesh), *self.properties}:
            _restore_property(mesh, name, self.properties)
        # Newer versions keep the name of an active layer that is gone.
        mesh.color_attributes.active_color_name = self.active_colour
        for name, fields in LISTS.items():
            _restore_rows(mesh, name, fields, self.rows[name])
        if PART.name in self.attributes and is_analyzed(mesh):
            _write_compound(mesh, self.attributes[PART.name][2].ravel())
        mesh.update()


def _write_compound(mesh: bpy.types.Mesh, labels: NDArray[np.int32]) -> None:
    """Write those outputs of parts (F,) that are more than attributes."""
    if lie_within(labels, 0, MOST_LABELS):
        state = read(mesh)
        division = division_of(labels, state.parts, state.softness)
        output_registry.write_compound(mesh, division, state.outputs)


def _own_properties(mesh: bpy.types.Mesh) -> list[str]:
    return [name for name in mesh.keys() if name.startswith(OWN_PROPERTIES)]  # noqa: SIM118


def _plain(value: Any) -> Any:
    return value.to_dict() if hasattr(value, "to_dict") else value


def _rows(mesh: bpy.types.Mesh, name: str, fields: tuple[str, ...]) -> list[tuple[Any, ...]]:
    # The command line does without the extension's properties.
    rows = getattr(mesh_settings(mesh), name) if hasattr(mesh, "eigenparts") else ()
    return [tuple(getattr(row, field) for field in fields) for row in rows]


def _restore_attribute(
    mesh: bpy.types.Mesh, name: str, data_type: AttributeType, domain: Domain, values: Values
) -> None:
    existing = mesh.attributes.get(name)
    if existing is not None and (existing.data_type, existing.domain) != (data_type, domain):
        mesh.attributes.remove(existing)
    if name not in mesh.attributes:
        mesh.attributes.new(name, type=data_type, domain=domain)
    store_values(mesh.attributes[name], values)


def _restore_property(mesh: bpy.types.Mesh, name: str, kept: dict[str, Any]) -> None:
    if mesh.get(name) is not None:
        del mesh[name]
    if name in kept:
        mesh[name] = kept[name]


def _restore_rows(mesh: bpy.types.Mesh, name: str, fields: tuple[str, ...], kept: list[tuple[Any, ...]]) -> None:
    # Whoever sets a property of a row still holds it, so rows are not made anew without need.
    if _rows(mesh, name, fields) == kept:
        return
    rows = getattr(mesh_settings(mesh), name)
    rows.clear()
    for values in kept:
        row = rows.add()
        for field, value in zip(fields, values, strict=True):
            setattr(row, field, value)
