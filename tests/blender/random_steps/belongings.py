"""All that is in a file, as values that can be compared: what a user has, and what operators left beside it.

Each value has a place: the kind of data-block, its name, and what it is of it: ("meshes", "star", "layer heat").
"""

import bpy
import numpy as np

from tests.blender.failing import plain

Place = tuple[str, str, str]

# Data-blocks that Blender itself makes as it goes along.
PASSING = {"window_managers", "workspaces", "screens", "libraries", "brushes", "palettes", "linestyles", "worlds"}
COMPONENTS = {
    **{"FLOAT_VECTOR": ("vector", 3), "FLOAT2": ("vector", 2), "FLOAT_COLOR": ("color", 4), "BYTE_COLOR": ("color", 4)},
    **{"QUATERNION": ("value", 4), "INT32_2D": ("value", 2), "INT16_2D": ("value", 2), "FLOAT4X4": ("value", 16)},
}
NUMBERS = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": bool, "INT32_2D": np.int32, "INT16_2D": np.int32}
# The groups of settings on scenes.
SETTINGS = ("eigenparts", "eigenparts_skeleton", "eigenparts_transfer")
MARKS = ("layer sharp_", "layer .select_", "layer .hide_", "layer .uv", "layer material_index")
GONE = "gone"
# Custom properties of Blender's own.
NOT_KEPT = (*SETTINGS, "eigenparts_points", "cycles")


def belongings() -> dict[Place, object]:
    """Return everything in the file."""
    active = _name(bpy.context.view_layer.objects.active)
    found: dict[Place, object] = {("view", "", ""): True, ("view", "", "active"): active}
    for kind in collections():
        for block in getattr(bpy.data, kind):
            describe = OF_KIND.get(kind, lambda block: {})
            names = set(block.keys()) - set(NOT_KEPT)
            properties = {f"property {name}": plain(block[name]) for name in names}
            values = {"": True, **properties, **describe(block)}
            found |= {(kind, block.name_full, what): value for what, value in values.items()}
    return found


def changed(before: dict[Place, object], after: dict[Place, object]) -> list[Place]:
    """Return the places that are different, new or gone."""
    return sorted(place for place in {*before, *after} if not _is_same(before.get(place, GONE), after.get(place, GONE)))


def _is_same(value: object, other: object) -> bool:
    # What is no number is not equal to itself.
    return value == other or repr(value) == repr(other)


def collections() -> list[str]:
    """Return the names of the lists of data-blocks in a file."""
    return sorted(
        declared.identifier
        for declared in bpy.data.bl_rna.properties
        if declared.type == "COLLECTION"
        and declared.identifier not in PASSING
        # Since 5.2 there is a list of all of them, too.
        and declared.fixed_type.identifier != "ID"
    )


def names_on(mesh: bpy.types.Mesh) -> set[str]:
    """Return the names of the layers on a mesh that are marked as ours, and of the groups."""
    marked = mesh.get("eigenparts_attributes", "")
    groups = mesh.get("eigenparts_groups")
    names = list(groups.to_dict().values()) if hasattr(groups, "to_dict") else []
    return {*(marked.splitlines() if isinstance(marked, str) else ()), *(f"group {name}" for name in names)}


def _of_object(obj: bpy.types.Object) -> dict[str, object]:
    active = obj.vertex_groups.active if obj.type == "MESH" else None
    return {
        **{"data": _name(obj.data), "parent": (_name(obj.parent), obj.parent_type, obj.parent_bone)},
        "matrix": [*map(tuple, obj.matrix_basis), *map(tuple, obj.matrix_parent_inverse)],
        "modifiers": [(one.name, one.type, _name(getattr(one, "object", None))) for one in obj.modifiers],
        **{"selected": obj.select_get() if obj.name in bpy.context.view_layer.objects else None, "mode": obj.mode},
        **{"hidden": (obj.hide_viewport, obj.hide_render, obj.hide_select), "active group": _name(active)},
        **{"collections": sorted(map(_name, obj.users_collection)), "key": obj.active_shape_key_index},
        **({f"group {name}": weights for name, weights in _groups(obj).items()} if obj.type == "MESH" else {}),
    }


def _groups(obj: bpy.types.Object) -> dict[str, list[tuple[int, float]]]:
    if obj.mode == "EDIT":
        return {}
    names = [group.name for group in obj.vertex_groups]
    weights: dict[str, list[tuple[int, float]]] = {name: [] for name in names}
    if names:
        for vertex in obj.data.vertices:
            for element in vertex.groups:
                weights[names[element.group]].append((vertex.index, round(element.weight, 6)))
    return weights


def _of_mesh(mesh: bpy.types.Mesh) -> dict[str, object]:
    # While a mesh is being edited, its layers are elsewhere.
    return {**_of_lists(mesh), **({} if mesh.is_editmode else _of_layers(mesh))}


def _of_lists(mesh: bpy.types.Mesh) -> dict[str, object]:
    return {
        "rows": [(row.part, row.depth, row.share, row.n_faces) for row in mesh.eigenparts.rows],
        "correction rows": [(row.place, row.title, row.rests) for row in mesh.eigenparts.correction_rows],
        **{"active part": mesh.eigenparts.active_part, "keys": _name(mesh.shape_keys)},
    }


def _of_layers(mesh: bpy.types.Mesh) -> dict[str, object]:
    starts = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    slots = [_name(slot) for slot in mesh.materials]
    values = {f"layer {one.name}": (one.data_type, one.domain, _values(one)) for one in mesh.attributes}
    return {
        **{name: value for name, value in values.items() if value[2] and not _marks_nothing(name, value[2])},
        **{"faces": starts.tobytes(), "normals": _normals(mesh), "slots": slots, **_of_users_slots(mesh)},
        "map": _name(mesh.uv_layers.active),
        "color": (mesh.color_attributes.active_color_name, mesh.color_attributes.render_color_index),
    }


def _marks_nothing(layer: str, values: object) -> bool:
    """Return whether a layer of Blender's own marks nothing, which is the same as no layer."""
    return layer.startswith(MARKS) and not any(values)


def _values(attribute: bpy.types.Attribute) -> object:
    if attribute.data_type == "STRING":
        return [element.value for element in attribute.data]
    name, components = COMPONENTS.get(attribute.data_type, ("value", 1))
    values = np.empty(components * len(attribute.data), dtype=NUMBERS.get(attribute.data_type, np.float32))
    attribute.data.foreach_get(name, values)
    return values.tobytes()


def _normals(mesh: bpy.types.Mesh) -> object:
    if not mesh.has_custom_normals:
        return None
    normals = np.empty(3 * len(mesh.corner_normals), dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", normals)
    # Where coordinates are no numbers, so are normals, each time others.
    return np.round(normals, 2).tobytes() if np.isfinite(normals).all() else "no numbers"


def _of_users_slots(mesh: bpy.types.Mesh) -> dict[str, object]:
    """Return the materials of the user's in the slots, and the one of each face below those of parts."""
    is_ours = [slot is not None and "eigenparts_part" in slot for slot in mesh.materials]
    own = [_name(slot) for slot, ours in zip(mesh.materials, is_ours, strict=True) if not ours]
    kept = mesh.attributes.get("eigenparts_previous_material" if any(is_ours) else "material_index")
    indices = [element.value for element in kept.data] if kept is not None else [0] * len(mesh.polygons)
    return {"user's slots": own, "user's faces": [own[i] if 0 <= i < len(own) else "" for i in indices]}


def _of_keys(keys: bpy.types.Key) -> dict[str, object]:
    places = {}
    for key in keys.key_blocks:
        # Keys of a mesh without vertices say that they have any number of points.
        is_empty = isinstance(keys.user, bpy.types.Mesh) and not len(keys.user.vertices)
        values = np.empty(0 if is_empty else 3 * len(key.data), dtype=np.float32)
        if not is_empty:
            key.data.foreach_get("co", values)
        settings = key.value, key.mute, key.slider_min, key.slider_max, key.vertex_group, _name(key.relative_key)
        places[f"key {key.name}"] = values.tobytes(), settings
    return places


def _of_armature(armature: bpy.types.Armature) -> dict[str, object]:
    return {"bones": [(bone.name, tuple(bone.head_local), tuple(bone.tail_local)) for bone in armature.bones]}


def _of_curve(curve: bpy.types.Curve) -> dict[str, object]:
    return {"splines": [[tuple(point.co) for point in spline.points] for spline in curve.splines]}


def _of_collection(collection: bpy.types.Collection) -> dict[str, object]:
    return {"children": [_name(child) for child in collection.children]}


def _of_material(material: bpy.types.Material) -> dict[str, object]:
    return {"colour": tuple(material.diffuse_color)}


def _of_scene(scene: bpy.types.Scene) -> dict[str, object]:
    pairs = [
        (_name(pair.source), pair.source_vertex, pair.n_source, _name(pair.target), pair.target_vertex, pair.n_target)
        for pair in scene.eigenparts_points
    ]
    return {"eigenparts_points": pairs} | {
        f"{group} {declared.identifier}": plain_setting(getattr(scene, group), declared)
        for group in SETTINGS
        for declared in getattr(scene, group).bl_rna.properties
        if declared.type in ("BOOLEAN", "INT", "FLOAT", "STRING", "ENUM")
    }


def plain_setting(owner: bpy.types.bpy_struct, declared: bpy.types.Property) -> object:
    """Return the value of a property of a group of settings."""
    value = getattr(owner, declared.identifier)
    return sorted(value) if isinstance(value, set) else value[:] if getattr(declared, "is_array", False) else value


def _name(block: object) -> str | None:
    return None if block is None else getattr(block, "name_full", None) or block.name


OF_KIND = {
    **{"objects": _of_object, "meshes": _of_mesh, "shape_keys": _of_keys, "armatures": _of_armature},
    **{"curves": _of_curve, "collections": _of_collection, "materials": _of_material, "scenes": _of_scene},
}
