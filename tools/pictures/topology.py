"""From the field to the parts: its level sets, its critical points with the lines between them, and its diagram."""

from pathlib import Path

import bpy
import numpy as np
from mathutils import Color
from PIL import Image

from eigenparts.operators.blender.known_values import elements_of, mesh_of, present, set_input
from examples import handles, humanoid
from tools.extension_operators import run_operator
from tools.pictures.bones import bone_objects
from tools.pictures.characters import add_mesh, analyze, level_of, segment, select, standing
from tools.pictures.lettering import sheet
from tools.pictures.shots import shot
from tools.render import MATERIAL, View

# Linear RGB of bodies that show no parts, between the white and the dark of the complex.
CLAY = (0.3, 0.31, 0.33, 1.0)
# Times the usual thickness of lines and dots.
THICKNESS = 2.0
# Colours of the field from its least to its greatest value, in sRGB; each band is one colour.
BANDS = (
    *("1f2a5a", "25467c", "2a639a", "2f82ad", "3ba0b0", "55b9a6", "7dcd99", "a8dc8f", "cfe788", "ebec8c", "f9efa0"),
    "fff6cf",
)


def draw_way(target: Path) -> None:
    """Write what becomes of a character: its field, the complex of the field, parts and bones."""
    obj = _humanoid("stand")
    view = View(azimuth=18, elevation=8, width=260, height=440, samples=16)
    images = [_shown_field(obj, view), _shown_complex(obj, -1, view), *_shown_parts_and_bones(obj, view)]
    sheet([images], titles=[["field", "Morse-Smale complex", "parts", "armature"]]).save(target)


def draw_complex_of_humanoid(target: Path) -> None:
    """Write the complex at a coarse level, at the default one and with all features."""
    obj = _humanoid()
    analyze(obj)
    default, n_levels, _ = level_of(obj)
    view = View(azimuth=14, elevation=8, width=500, height=480, samples=16)
    levels = (2, default, n_levels - 1)
    images = [_shown_complex(obj, level, view) for level in levels]
    titles = ["level 2", f"level {default}, the default", f"level {n_levels - 1}, all features"]
    sheet([images], titles=[titles]).save(target)


def draw_complex_of_handles(target: Path) -> None:
    """Write the complex of a body with two handles."""
    body = handles(2, 6000)
    obj = add_mesh("Handles", body.vertices, body.quads)
    view = View(azimuth=24, elevation=14, width=900, height=560, samples=16)
    _shown_complex(obj, -1, view).save(target)


def draw_diagram(target: Path) -> None:
    """Write the persistence diagram as the operator draws it."""
    obj = _humanoid()
    select([obj])
    run_operator("plot_diagram")
    image = next(image for image in bpy.data.images if image.name.startswith("Diagram"))
    image.filepath_raw, image.file_format = str(target), "PNG"
    image.save()


def _humanoid(pose: str = "rest") -> bpy.types.Object:
    character = humanoid()
    return add_mesh("Humanoid", standing(character, character.poses[pose]), character.quads)


def _shown_complex(obj: bpy.types.Object, level: int, view: View) -> Image.Image:
    """Return a picture of an object in clay with its complex on it."""
    select([obj])
    run_operator("trace_complex", level=level, thickness=THICKNESS)
    body = add_copy(obj)
    image = shot([body, *obj.children], view)
    bpy.data.objects.remove(body)
    return image


def _shown_field(obj: bpy.types.Object, view: View) -> Image.Image:
    """Return a picture of the field in bands of equal height, so that their borders are level sets."""
    analyze(obj)
    select([obj])
    run_operator("write_outputs", outputs={"CORNER_COLORS", "FIELD"})
    mesh = mesh_of(obj)
    values = np.empty(len(mesh.vertices), dtype=np.float32)
    elements_of(mesh.attributes["eigenparts_field"]).foreach_get("value", values)
    body = add_copy(obj)
    mesh_of(body).materials.append(_banded("eigenparts_field", float(values.min()), float(values.max())))
    image = shot([body], view)
    bpy.data.objects.remove(body)
    return image


def _shown_parts_and_bones(obj: bpy.types.Object, view: View) -> list[Image.Image]:
    segment(obj)
    images = [shot([obj], view)]
    select([obj])
    run_operator("create_armature")
    images.append(shot([obj], view, bone_objects(present(bpy.context.object))))
    return images


def add_copy(obj: bpy.types.Object) -> bpy.types.Object:
    """Add a copy of an object without the colours of its parts, in clay."""
    mesh = present(mesh_of(obj).copy())
    copy = bpy.data.objects.new("Clay", mesh)
    colours = mesh.color_attributes
    for attribute in list(colours):
        colours.remove(attribute)
    copy.color.foreach_set(CLAY)
    present(bpy.context.collection).objects.link(copy)
    return copy


def _banded(attribute: str, least: float, greatest: float) -> bpy.types.Material:
    """Return a material that shows an attribute in bands."""
    material = bpy.data.materials.new(f"{MATERIAL} bands")
    if material.node_tree is None:
        material.use_nodes = True
    tree = present(material.node_tree)
    nodes, links = tree.nodes, tree.links
    read, scaled, ramp = _attribute_node(nodes, attribute), nodes.new("ShaderNodeMapRange"), _band_node(nodes)
    set_input(scaled, "From Min", least)
    set_input(scaled, "From Max", greatest)
    links.new(read.outputs["Fac"], scaled.inputs["Value"])
    links.new(scaled.outputs["Result"], ramp.inputs["Fac"])
    surface = nodes["Principled BSDF"]
    set_input(surface, "Roughness", 0.55)
    set_input(surface, "Specular IOR Level", 0.25)
    links.new(ramp.outputs["Color"], surface.inputs["Base Color"])
    return material


def _attribute_node(nodes: bpy.types.Nodes, attribute: str) -> bpy.types.Node:
    node = nodes.new("ShaderNodeAttribute")
    assert isinstance(node, bpy.types.ShaderNodeAttribute)
    node.attribute_name = attribute
    return node


def _band_node(nodes: bpy.types.Nodes) -> bpy.types.Node:
    node = nodes.new("ShaderNodeValToRGB")
    assert isinstance(node, bpy.types.ShaderNodeValToRGB)
    _fill(present(node.color_ramp))
    return node


def _fill(ramp: bpy.types.ColorRamp) -> None:
    """Give a ramp the colours of the bands, with sharp borders."""
    ramp.interpolation = "CONSTANT"
    while len(ramp.elements) < len(BANDS):
        ramp.elements.new(1.0)
    for number, (element, colour) in enumerate(zip(ramp.elements, BANDS, strict=True)):
        element.position = number / len(BANDS)
        linear = _linear(colour)
        element.color.foreach_set((linear.r, linear.g, linear.b, 1.0))


def _linear(colour: str) -> Color:
    """Return linear RGB of a hexadecimal colour of the screen."""
    return Color([component / 255 for component in bytes.fromhex(colour)]).from_srgb_to_scene_linear()
