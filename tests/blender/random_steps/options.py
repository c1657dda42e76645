"""Values for properties, likely ones or any, read off what Blender knows of each property."""

from random import Random

import bpy

WHOLE = [0, 1, 2, 3, 6, 7, -1, 99, 2**31 - 1, -(2**31)]
DECIMAL = [0.0, 0.05, -0.05, 0.3, -0.3, 0.5, 1.0, -1.0, 1e-6, 1e6, float("inf"), float("nan")]
TEXTS = ["", "heat", "part", "grip", "wide", "Head", "../../x", "Ä" * 40, "x" * 100, "nobody knows"]
LIKELY = {
    "INT": [0, 1, 1, 2, 2, 3, 4],
    "FLOAT": [0.0, 0.02, -0.02, 0.05, 0.3, 0.5, 1.0],
    # Cubic elements are as good as others here, and take longer.
    "order": ["1", "1", "1", "1", "AUTO", "2", "3"],
    "boundary": ["NEUMANN", "NEUMANN", "NEUMANN", "DIRICHLET"],
    "borders": ["EDGES", "EDGES", "EXACT"],
    "field": ["DIFFUSION", "DIFFUSION", "DIFFUSION", "EIGENFUNCTION", "ATTRIBUTE"],
    **{"attribute": ["heat"], "mask": ["", "", "grip"], "group_names": ["grip"], "object_name": [""]},
    **{"index": [0], "into": [0], "source": [""], "source_vertex": [0, 1, 5, 9], "target_vertex": [0, 1, 5, 9]},
}
# Those that a call without them is about something else.
ALWAYS = {"order", "part", "into", "attribute", "location", "target"}
# From how far above the picked vertex the ray comes, in its own height.
ABOVE = 10


def options_of(operator: str, chance: Random, is_likely: bool) -> dict[str, object]:
    """Return options for an operator, such as users choose or any; all are of the right type."""
    rna = getattr(bpy.ops.eigenparts, operator).get_rna_type()
    return {
        declared.identifier: value_of(declared, chance, is_likely)
        for declared in sorted(rna.properties, key=lambda one: one.identifier)
        if declared.identifier != "rna_type" and chance.random() < (0.8 if declared.identifier in ALWAYS else 0.3)
    }


def value_of(declared: bpy.types.Property, chance: Random, is_likely: bool) -> object:
    """Return a value for a property; one for each component where it has several."""
    if is_likely and declared.identifier in ("location", "direction"):
        return _ray(chance)[declared.identifier]
    if getattr(declared, "is_array", False):
        return [_single(declared, chance, is_likely) for _ in range(declared.array_length)]
    return _single(declared, chance, is_likely)


def _single(declared: bpy.types.Property, chance: Random, is_likely: bool) -> object:
    active, kind = bpy.context.object, declared.type
    mesh = active.data if active is not None and active.type == "MESH" else None
    if kind == "BOOLEAN":
        return chance.random() < 0.5
    if kind == "ENUM":
        return _choice(declared, chance)
    if is_likely and declared.identifier in LIKELY:
        return chance.choice(LIKELY[declared.identifier])
    if is_likely and declared.identifier == "target":
        return chance.choice([obj.name for obj in bpy.context.view_layer.objects if obj.type == "MESH"] or [""])
    if kind == "STRING":
        return chance.choice([*TEXTS, *_names(mesh)])
    if is_likely and declared.identifier == "part":
        return chance.choice([part for part in _parts(mesh) if part] or [0])
    return chance.choice(LIKELY[kind] if is_likely else WHOLE if kind == "INT" else DECIMAL)


def _ray(chance: Random) -> dict[str, list[float]]:
    """Return where a ray begins that meets the active object from above, and its direction."""
    obj = bpy.context.object
    vertices = obj.data.vertices if obj is not None and obj.type == "MESH" else ()
    place = obj.matrix_world @ chance.choice(vertices).co if len(vertices) else (0.0, 0.0, 0.0)
    x, y, z = place
    return {"location": [x, y, z + ABOVE * (1 + abs(z))], "direction": [0.0, 0.0, -1.0]}


def _choice(declared: bpy.types.Property, chance: Random) -> object:
    items = declared.enum_items.keys()
    if declared.is_enum_flag:
        return sorted(chance.sample(items, chance.randint(0, len(items))))
    return chance.choice(LIKELY.get(declared.identifier, items))


def _parts(mesh: bpy.types.Mesh | None) -> list[int]:
    return [row.part for row in mesh.eigenparts.rows][:20] if mesh is not None else []


def _names(mesh: bpy.types.Mesh | None) -> list[str]:
    objects = [obj.name for obj in bpy.data.objects]
    return objects if mesh is None else [*objects, *mesh.attributes.keys()]
