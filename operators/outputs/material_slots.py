"""Output: a material for each part, in slots behind those of the user, whose assignment is kept and given back."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..blender.known_values import elements_of, present, set_input, values_of
from ..mesh_data.mesh_arrays import OwnAttribute, own_names, read_own_integers, remove_own_attributes, write_attribute
from .division import Division
from .output import Output

# What the user had assigned to the faces before; absent if all faces had the first slot.
PREVIOUS_MATERIAL = OwnAttribute("eigenparts_previous_material", "INT", "FACE")

# What is in a slot: a material of the user's, none, or the part that one of ours belongs to.
Slot = bpy.types.Material | int | None

MATERIAL_INDEX = "material_index"
# On our materials: the part they belong to.
PART_OF_MATERIAL = "eigenparts_part"
# Of the number that Blender adds to a name that is taken, and bytes from which on it may have cut a name short.
N_DIGITS, LONG_NAME = 3, 60
# On the mesh while it has our materials.
IS_WRITTEN = "eigenparts_materials"


def write(mesh: bpy.types.Mesh, division: Division) -> None:
    """Give every part that has faces a slot with a material of its name and colour."""
    if not _is_written(mesh):
        _keep_assignment(mesh)
        mesh[IS_WRITTEN] = True
    _drop_slots(mesh, set(division.names))
    slot_of_part = np.zeros(len(division.colours), dtype=np.int32)
    for part, name in division.names.items():
        slot_of_part[part] = slot = _slot(mesh, part)
        colour = division.colours[part].tolist()
        material = present(mesh.materials[slot])
        if not _is_dressed(material, name, colour):
            if material.users > 1:
                # A copy of the mesh has it too, and keeps it as it is.
                mesh.materials[slot] = material = _new_material(part)
            _dress(material, name, colour)
    _assign(mesh, slot_of_part[division.labels])


def remove(mesh: bpy.types.Mesh) -> None:
    """Take our slots away and give the faces the materials they had."""
    if not _is_written(mesh):
        return
    if PREVIOUS_MATERIAL.name in own_names(mesh) and PREVIOUS_MATERIAL.name in mesh.attributes:
        previous = read_own_integers(mesh, PREVIOUS_MATERIAL)
        remove_own_attributes(mesh, [PREVIOUS_MATERIAL.name])
        _drop_slots(mesh, set())
        _assign(mesh, previous)
    else:
        _drop_slots(mesh, set())
        forget_assignment(mesh)
    del mesh[IS_WRITTEN]


def assignment_of_user(mesh: bpy.types.Mesh) -> tuple[tuple[str, ...], NDArray[np.int32]]:
    """Return the names in the slots that are the user's, "" where a slot is empty, and the (F,) slot of each face."""
    is_written = _is_written(mesh)
    slots = [material for material in mesh.materials if not (is_written and _is_own(material))]
    kept = mesh.attributes.get(PREVIOUS_MATERIAL.name if is_written else MATERIAL_INDEX)
    indices = np.zeros(len(mesh.polygons), dtype=np.int32)
    if kept is not None:
        elements_of(kept).foreach_get("value", indices)
    return tuple(material.name if material else "" for material in slots), indices


def slots_of(mesh: bpy.types.Mesh) -> list[Slot]:
    """Return the material of each slot that is the user's, and the part that it belongs to where it is ours."""
    return [material if (part := _own_part(material)) is None else part for material in mesh.materials]


def restore(mesh: bpy.types.Mesh, kept: list[Slot]) -> None:
    """Give a mesh the slots that it had; materials of ours that are gone are made anew, the next writing dresses them.

    Others of ours that nobody uses are removed.
    """
    material_of_part = {_own_part(material): material for material in mesh.materials if _is_own(material)}
    while len(mesh.materials) > len(kept):
        mesh.materials.pop(index=len(mesh.materials) - 1)
    while len(mesh.materials) < len(kept):
        mesh.materials.append(None)
    for slot, known in enumerate(kept):
        mesh.materials[slot] = (
            (material_of_part.get(known) or _new_material(known)) if isinstance(known, int) else known
        )
    for material in [material for material in bpy.data.materials if _is_own(material) and material.users == 0]:
        bpy.data.materials.remove(material)


def forget_assignment(mesh: bpy.types.Mesh) -> None:
    """Let all faces have the first slot."""
    if (attribute := mesh.attributes.get(MATERIAL_INDEX)) is not None:
        mesh.attributes.remove(attribute)


def _is_own(material: bpy.types.Material | None) -> bool:
    return _own_part(material) is not None


def _own_part(material: bpy.types.Material | None) -> int | None:
    """Return the part of a material of ours, None for any other."""
    part = None if material is None else material.get(PART_OF_MATERIAL)
    return part if isinstance(part, int) else None


def _is_written(mesh: bpy.types.Mesh) -> bool:
    return mesh.get(IS_WRITTEN) is not None


def _keep_assignment(mesh: bpy.types.Mesh) -> None:
    if MATERIAL_INDEX in mesh.attributes:
        indices = np.empty(len(mesh.polygons), dtype=np.int32)
        elements_of(mesh.attributes[MATERIAL_INDEX]).foreach_get("value", indices)
        write_attribute(mesh, PREVIOUS_MATERIAL, indices)


def _drop_slots(mesh: bpy.types.Mesh, kept: set[int]) -> None:
    """Remove the slots of ours whose parts are not to be kept, and materials that nobody uses any more."""
    for slot in reversed(range(len(mesh.materials))):
        material = mesh.materials[slot]
        if material is not None and _is_own(material):
            if _own_part(material) in kept:
                continue
            mesh.materials.pop(index=slot)
            if material.users == 0:
                bpy.data.materials.remove(material)


def _slot(mesh: bpy.types.Mesh, part: int) -> int:
    """Return the slot of a part's material, a new one if there is none."""
    for slot, material in enumerate(mesh.materials):
        if material is not None and material.get(PART_OF_MATERIAL) == part:
            return slot
    mesh.materials.append(_new_material(part))
    return len(mesh.materials) - 1


def _new_material(part: int) -> bpy.types.Material:
    material = bpy.data.materials.new("Part")
    material[PART_OF_MATERIAL] = part
    return material


def _is_dressed(material: bpy.types.Material, name: str, colour: list[float]) -> bool:
    return _has_name(material, name) and _shown_colour(material) == colour


def _shown_colour(material: bpy.types.Material) -> list[float]:
    return list(values_of(material.diffuse_color))


def _has_name(material: bpy.types.Material, name: str) -> bool:
    """Whether a material has a name, also with the number that Blender adds where it is taken, or cut short."""
    stem, _, number = material.name.rpartition(".")
    if not (number.isdecimal() and len(number) == N_DIGITS):
        stem = material.name
    is_cut = len(material.name.encode()) >= LONG_NAME
    return name in (material.name, stem) or (is_cut and name.startswith(stem))


def _dress(material: bpy.types.Material, name: str, colour: list[float]) -> None:
    """Give a material name and colour, in solid view and, from Blender 5 on where all have nodes, in its shader."""
    if not _has_name(material, name):
        material.name = name
    if _shown_colour(material) != colour:
        material.diffuse_color.foreach_set(colour)
        shader = material.node_tree.nodes.get("Principled BSDF") if material.node_tree else None
        if shader is not None:
            set_input(shader, "Base Color", colour)


def _assign(mesh: bpy.types.Mesh, slots: NDArray[np.int32]) -> None:
    if MATERIAL_INDEX not in mesh.attributes:
        mesh.attributes.new(MATERIAL_INDEX, "INT", "FACE")
    elements_of(mesh.attributes[MATERIAL_INDEX]).foreach_set("value", np.ascontiguousarray(slots, dtype=np.int32))


OUTPUT = Output(
    "MATERIALS",
    "Materials",
    "A material slot for each part; your own assignment comes back",
    (PREVIOUS_MATERIAL,),
    write,
    remove,
    shows_colours=True,
    is_compound=True,
)
