"""Give every part a material, for the formats that know nothing else of parts."""

import bpy

from ..operators.exchange import read_own_integers
from ..operators.palette import colours_of_labels
from ..operators.results import PART
from .names import name_of_part


def give_parts_materials() -> None:
    """Replace the materials of all divided meshes that are open, one for each part."""
    for mesh in {obj.data for obj in bpy.data.objects if obj.type == "MESH"}:
        if PART.name in mesh.attributes:
            _give_materials(mesh)


def _give_materials(mesh: bpy.types.Mesh) -> None:
    labels = read_own_integers(mesh, PART)
    n_labels = int(labels.max(initial=0)) + 1
    mesh.materials.clear()
    for label, colour in enumerate(colours_of_labels(n_labels).tolist()):
        mesh.materials.append(_material(name_of_part(label), colour))
    mesh.polygons.foreach_set("material_index", labels)


def _material(name: str, colour: list[float]) -> bpy.types.Material:
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    material.diffuse_color = colour
    if material.node_tree is None:
        material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = colour
    return material
