"""Functions that fail when they are called for the n-th time, and all that may not change then."""

import re
import sys
from contextlib import suppress

import bpy
import numpy as np

from tests.blender.conftest import everything_on, values_of

STATE = "eigenparts_state"


def all_of(mesh):
    """Return everything on a mesh with the values in our state, and its faces."""
    rows = [(row.part, row.share, row.n_faces) for row in mesh.eigenparts.rows]
    state = repr(plain(mesh[STATE])) if STATE in mesh else None
    corners = values_of(mesh, ".corner_vert").tobytes()
    positions = values_of(mesh, "position", 3, np.float32, "vector").tobytes()
    return everything_on(mesh), rows, state, corners, positions, groups_of(mesh), materials_of(mesh)


def groups_of(mesh):
    """Return the weights of each vertex group, by its name."""
    obj = next(obj for obj in bpy.data.objects if obj.data == mesh)
    names = {group.index: group.name for group in obj.vertex_groups}
    weights = {name: {} for name in names.values()}
    for vertex in mesh.vertices:
        for element in vertex.groups:
            weights[names[element.group]][vertex.index] = round(element.weight, 6)
    return weights


def materials_of(mesh):
    """Return the names and colours of the slots, and of the material of each face."""
    slots = [(slot.name, tuple(slot.diffuse_color)) if slot else None for slot in mesh.materials]
    return slots, [polygon.material_index for polygon in mesh.polygons]


def object_as_it_is(obj):
    """Return where an object hangs, what modifies it, and its shape keys with their drivers."""
    keys = obj.data.shape_keys.key_blocks if obj.data.shape_keys else ()
    animation = obj.data.shape_keys.animation_data if obj.data.shape_keys else None
    drivers = [curve.data_path for curve in animation.drivers] if animation else []
    shapes = {key.name: np.array([point.co for point in key.data]).tobytes() for key in keys}
    where = tuple(map(tuple, obj.matrix_world)), obj.parent, [modifier.name for modifier in obj.modifiers]
    return where, shapes, drivers, [layer.name for layer in obj.data.uv_layers]


def blocks():
    """Return the names of all objects and of what they could be made of."""
    kinds = ("objects", "meshes", "armatures", "curves", "collections", "materials")
    return {kind: sorted(block.name for block in getattr(bpy.data, kind)) for kind in kinds}


def fails_at_every_call(monkeypatch, writer, call, unchanged, error=MemoryError):
    """Let each call of a writer fail in turn, and look each time; return how many there were."""
    for n in range(1, 1000):
        with monkeypatch.context() as patch:
            failing = fail_at(patch, writer, n, error)
            with suppress(RuntimeError):
                call()
            if failing.n_calls < n:
                return n - 1
        unchanged()
    raise AssertionError("it never ended")


def plain(value):
    """Return a custom property as values that can be compared."""
    if isinstance(value, bpy.types.ID):
        return type(value).__name__, value.name_full
    if hasattr(value, "to_dict"):
        return {name: plain(value[name]) for name in sorted(value.keys())}
    if isinstance(value, list):
        return [plain(item) for item in value]
    return list(value) if hasattr(value, "typecode") else value


class Failing:
    """A function that raises when it is called for the n-th time, and counts."""

    def __init__(self, function, n, error=MemoryError):
        self.function, self.n, self.error, self.n_calls = function, n, error, 0

    def __call__(self, *arguments, **options):
        self.n_calls += 1
        if self.n_calls == self.n:
            raise self.error
        return self.function(*arguments, **options)


def module_of_operators(name):
    """Return the module of this name in the rooms of the operators."""
    [found] = [
        module for path, module in sys.modules.items() if re.fullmatch(rf"eigenparts\.operators\.\w+\.{name}", path)
    ]
    return found


def fail_at(monkeypatch, name, n, error=MemoryError):
    """Let the n-th call of a function of the operators fail, and return it."""
    module, function = name.split(".")
    owner = module_of_operators(module)
    failing = Failing(getattr(owner, function), n, error)
    monkeypatch.setattr(owner, function, failing)
    return failing
