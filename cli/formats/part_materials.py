"""Give every part materials, for the formats that know nothing else of parts; what a file had keeps its look."""

from __future__ import annotations

import re

import bpy
import numpy as np
from numpy.typing import NDArray

from ...operators.blender.known_values import mesh_of, present, set_input
from ...operators.mesh_data.mesh_arrays import own_names, read_own_integers, remove_own_attributes
from ...operators.mesh_state.state import is_analyzed, read
from ...operators.outputs import corner_colours
from ...operators.outputs.division import PART
from ..reports.part_names import name_of_part, names_of_parts

# On materials of ours, in formats that keep custom properties: the name of the material they are a copy of, if any.
COPY_OF = "eigenparts_copy_of"
# What they are called in formats that do not.
OWN_NAME = re.compile(r"(?:body|part_\d+)(?:\.(?P<copied>.+))?")

Material = bpy.types.Material | None


def give_parts_materials() -> None:
    """Let all divided meshes that are open tell their parts by the names of materials, and by nothing else of ours."""
    for mesh in {mesh_of(obj) for obj in bpy.data.objects if obj.type == "MESH"}:
        if is_analyzed(mesh) and PART.name in mesh.attributes:
            _give_materials(mesh)
            _leave_out_what_is_ours(mesh)


def has_colours_of_user() -> bool:
    """Whether a mesh that is open has colour attributes that are not ours."""
    return any(set(mesh.color_attributes.keys()) - set(own_names(mesh)) for mesh in bpy.data.meshes)


def _give_materials(mesh: bpy.types.Mesh) -> None:
    """Give each part a material of its name and colour, and a copy of each that its faces had before."""
    labels = read_own_integers(mesh, PART)
    slots: list[Material] = [None if _is_of_part_alone(material) else material for material in mesh.materials] or [None]
    pairs, material_index = np.unique(
        np.stack([labels, _slots_of_faces(mesh, len(slots))]), axis=1, return_inverse=True
    )
    colours, given = read(mesh).parts.colours_of(int(labels.max(initial=0)) + 1), names_of_parts(mesh)
    mesh.materials.clear()
    for label, slot in pairs.T.tolist():
        name, before = name_of_part(label, given), slots[slot]
        mesh.materials.append(_coloured(name, colours[label].tolist()) if before is None else _copied(name, before))
    mesh.polygons.foreach_set("material_index", material_index.reshape(-1).astype(np.int32))


def _slots_of_faces(mesh: bpy.types.Mesh, n_slots: int) -> NDArray[np.int32]:
    slots = np.zeros(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", slots)
    return np.clip(slots, 0, n_slots - 1)


def _is_of_part_alone(material: Material) -> bool:
    return material is not None and material.get(COPY_OF) == ""


def _coloured(name: str, colour: list[float]) -> bpy.types.Material:
    """Return the material of a part whose faces had none."""
    material = _named(name, "") or bpy.data.materials.new(name)
    material[COPY_OF] = ""
    material.diffuse_color.foreach_set(colour)
    if material.node_tree is None:
        material.use_nodes = True
    set_input(present(material.node_tree).nodes["Principled BSDF"], "Base Color", colour)
    return material


def _copied(part: str, before: bpy.types.Material) -> bpy.types.Material:
    """Return a copy of a material, with its colours and images, that is called after a part."""
    own = OWN_NAME.fullmatch(before.name)
    copied = before.get(COPY_OF) or ((own["copied"] or "") if own else before.name)
    name = f"{part}.{copied}" if copied else part
    material = _named(name, copied or before.name)
    if material is None:
        material = present(before.copy())
        if holder := bpy.data.materials.get(name):
            holder.name = f"{name} before"
        material.name, material[COPY_OF] = name, copied or before.name
    return material


def _named(name: str, copied: str) -> bpy.types.Material | None:
    """Return the material of a part if another mesh of the file was given it."""
    material = bpy.data.materials.get(name)
    return material if material is not None and material.get(COPY_OF) == copied else None


def _leave_out_what_is_ours(mesh: bpy.types.Mesh) -> None:
    """Take all but the materials back, which other programs could not understand."""
    corner_colours.remove(mesh)
    remove_own_attributes(mesh, own_names(mesh))
    for name in [name for name in mesh.keys() if name.startswith("eigenparts")]:  # noqa: SIM118
        del mesh[name]
