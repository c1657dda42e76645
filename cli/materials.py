"""Give every part a material, for the formats that know nothing else of parts."""

import bpy
import numpy as np

from ..operators.blender.known_values import mesh_of, present, set_input
from ..operators.mesh_data.mesh_arrays import read_own_integers
from ..operators.mesh_state.state import is_analyzed, read
from ..operators.outputs.division import PART
from .part_names import name_of_part, names_of_parts


def give_parts_materials() -> None:
    """Replace the materials of all divided meshes that are open, one for each part."""
    for mesh in {mesh_of(obj) for obj in bpy.data.objects if obj.type == "MESH"}:
        if is_analyzed(mesh) and PART.name in mesh.attributes:
            _give_materials(mesh)


def _give_materials(mesh: bpy.types.Mesh) -> None:
    labels = read_own_integers(mesh, PART)
    used, material_index = np.unique(labels, return_inverse=True)
    colours, given = read(mesh).parts.colours_of(int(labels.max(initial=0)) + 1), names_of_parts(mesh)
    mesh.materials.clear()
    for label in used.tolist():
        mesh.materials.append(_material(name_of_part(label, given), colours[label].tolist()))
    mesh.polygons.foreach_set("material_index", material_index.reshape(-1).astype(np.int32))


def _material(name: str, colour: list[float]) -> bpy.types.Material:
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    material.diffuse_color.foreach_set(colour)
    if material.node_tree is None:
        material.use_nodes = True
    set_input(present(material.node_tree).nodes["Principled BSDF"], "Base Color", colour)
    return material
