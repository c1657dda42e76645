"""Small objects of many kinds, with much on them that is the user's."""

from collections.abc import Iterable
from itertools import product
from random import Random

import bpy
import numpy as np

from tests.blender.conftest import add_object, give_custom_normals
from tests.shapes import icosphere, joined, rectangle, star, tetrahedron, torus

# Cells of half a body: torso, head, arm and leg. The other half is their mirror image in the plane x = 0.
HALF_BODY = [(0, 0, z) for z in (2, 3, 4, 5)] + [(x, 0, 4) for x in (1, 2, 3)] + [(1, 0, z) for z in (0, 1, 2)]
CORNERS = np.array(list(product((0, 1), repeat=3)))
# The corners of each side of a cell, seen from outside in a row, by the direction to the neighbour.
SIDES = {
    **{(-1, 0, 0): (0, 1, 3, 2), (1, 0, 0): (4, 6, 7, 5), (0, -1, 0): (0, 4, 5, 1)},
    **{(0, 1, 0): (2, 3, 7, 6), (0, 0, -1): (0, 2, 6, 4), (0, 0, 1): (1, 5, 7, 3)},
}


def blocks(cells: Iterable[tuple[int, int, int]], is_open=lambda cell: False):
    """Return vertices and quads of the surface of unit cells; sides to cells that `is_open` are left out."""
    cells = set(cells)
    corners = [
        tuple(np.add(cell, CORNERS[corner]).tolist())
        for cell in sorted(cells)
        for step, side in SIDES.items()
        for there in [tuple(np.add(cell, step).tolist())]
        if there not in cells and not is_open(there)
        for corner in side
    ]
    vertices, numbers = np.unique(np.array(corners, dtype=float), axis=0, return_inverse=True)
    return vertices, numbers.reshape(-1, 4)


def halved(cells):
    """Return the cells of half the size that fill some cells."""
    return [tuple((2 * np.array(cell) + corner).tolist()) for cell in cells for corner in CORNERS]


def body():
    """Return a body of quads with head, arms and legs."""
    return blocks(halved(HALF_BODY + [(-1 - x, y, z) for x, y, z in HALF_BODY]))


def half_body():
    """Return its half, open where the halves meet."""
    return blocks(halved(HALF_BODY), is_open=lambda cell: cell[0] < 0)


def _of(shape):
    return shape.vertices, shape.triangles


SHAPES = {
    "body": body,
    "half": half_body,
    "star": lambda: _of(star(5, 2)),
    "little star": lambda: _of(star(3, 1)),
    "ring": lambda: _of(torus(10, 6)),
    "sheet": lambda: _of(rectangle(6, 4)),
    "two": lambda: _of(joined(star(3, 1), icosphere(1))),
    "crystal": lambda: _of(tetrahedron(1)),
    "face": lambda: ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]),
    "points": lambda: ([(0, 0, 0), (1, 0, 0)], []),
    "nothing": lambda: ([], []),
}
OTHERS = {
    "camera": lambda: bpy.data.cameras.new("camera"),
    "curve": lambda: bpy.data.curves.new("curve", "CURVE"),
    "text": lambda: bpy.data.curves.new("text", "FONT"),
    "lattice": lambda: bpy.data.lattices.new("lattice"),
    "light": lambda: bpy.data.lights.new("light", "POINT"),
    "armature": lambda: bpy.data.armatures.new("armature"),
    "empty": lambda: None,
}
# The user's layers.
LAYERS = {
    **{"heat": ("FLOAT", "POINT"), "marks": ("INT", "FACE"), "paint": ("FLOAT_COLOR", "CORNER")},
    **{"seams": ("BOOLEAN", "EDGE"), "flow": ("FLOAT_VECTOR", "POINT")},
}
# Those that stand where results belong.
CLASHING = {"part": ("FLOAT", "POINT"), "part_vertex": ("FLOAT", "POINT"), ".sculpt_face_set": ("INT", "FACE")}
PROPERTIES = {"FLOAT": "value", "INT": "value", "BOOLEAN": "value", "FLOAT_COLOR": "color", "FLOAT_VECTOR": "vector"}


def add_cast(chance: Random) -> None:
    """Add one of each kind, some twice: shared, in another pose, hidden, bound to an armature."""
    bound = add_shape("body", chance)
    pose = add_shape("body", chance)
    pose.data.vertices.foreach_set("co", _bent(pose.data).ravel())
    add_shape("half", chance).modifiers.new("Mirror", "MIRROR")
    shared = add_shape("star", chance)
    for name in ("star", "two", "ring", "nothing"):
        add_shape(name, chance)
    add_shape("little star", chance).hide_set(True)
    twin = shared.copy()
    bpy.context.collection.objects.link(twin)
    for kind in OTHERS:
        add_other(kind)
    bound.modifiers.new("Armature", "ARMATURE").object = bpy.data.objects["armature"]
    select(bound)


def add_shape(name: str, chance: Random) -> bpy.types.Object:
    """Add a mesh of a shape with all that a user may have on one."""
    vertices, faces = SHAPES[name]()
    noise = np.random.default_rng(chance.randrange(2**32))
    vertices = np.reshape(vertices, (-1, 3)) + 0.02 * noise.standard_normal((len(vertices), 3))
    obj = add_object(chance.choice([1, 1, 1e-3, 1e3]) * vertices, faces, name)
    furnish(obj, chance)
    select(obj)
    return obj


def add_other(kind: str) -> bpy.types.Object:
    """Add an object that is no mesh."""
    obj = bpy.data.objects.new(kind, OTHERS[kind]())
    bpy.context.collection.objects.link(obj)
    obj["kept"] = "mine"
    return obj


def furnish(obj: bpy.types.Object, chance: Random) -> None:
    """Give an object layers, groups, materials, shape keys, normals and properties of the user's."""
    for name in chance.sample(sorted(LAYERS), chance.choice([0, 3, 5])):
        add_layer(obj.data, name, chance)
    if chance.random() < 0.1:
        add_layer(obj.data, chance.choice(sorted(CLASHING)), chance)
    obj.data["note"] = [1, 2, 3]
    obj["kept"] = "mine"
    for give in chance.sample([_give_maps, _give_groups, _give_materials, _give_keys, _give_normals], 3):
        if len(obj.data.polygons):
            give(obj, chance)


def add_layer(mesh: bpy.types.Mesh, name: str, chance: Random) -> None:
    """Add one of the user's layers with values of its own."""
    kind, domain = {**LAYERS, **CLASHING}[name]
    mesh.attributes.new(name, kind, domain)
    elements = mesh.attributes[name].data
    values = np.random.default_rng(chance.randrange(2**32)).random(
        len(elements) * {"FLOAT_COLOR": 4, "FLOAT_VECTOR": 3}.get(kind, 1)
    )
    values = values > 0.5 if kind == "BOOLEAN" else (9 * values).astype(np.int32) if kind == "INT" else values
    elements.foreach_set(PROPERTIES[kind], values.astype(np.float32) if values.dtype == float else values)


def select(obj: bpy.types.Object) -> None:
    """Make an object active and the only one that is selected."""
    for other in bpy.context.view_layer.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj


def _bent(mesh: bpy.types.Mesh) -> np.ndarray:
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    places = places.reshape(-1, 3)
    return places + np.stack([0 * places[:, 0], 0.05 * places[:, 0] ** 2, 0 * places[:, 0]], axis=1)


def _give_maps(obj: bpy.types.Object, chance: Random) -> None:
    obj.data.uv_layers.new(name="map")


def _give_groups(obj: bpy.types.Object, chance: Random) -> None:
    for name in ("grip", "none"):
        obj.vertex_groups.new(name=name)
    for vertex in range(0, len(obj.data.vertices), 3):
        obj.vertex_groups["grip"].add([vertex], chance.random(), "REPLACE")


def _give_materials(obj: bpy.types.Object, chance: Random) -> None:
    for name in ("skin", "cloth"):
        obj.data.materials.append(bpy.data.materials.get(name) or bpy.data.materials.new(name))
    obj.data.polygons.foreach_set("material_index", [chance.randrange(2) for _ in obj.data.polygons])


def _give_keys(obj: bpy.types.Object, chance: Random) -> None:
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="wide")
    key.data[0].co.x += 1
    key.value = chance.random()


def _give_normals(obj: bpy.types.Object, chance: Random) -> None:
    give_custom_normals(obj.data)
