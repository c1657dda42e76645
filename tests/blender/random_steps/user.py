"""What users do in between: they edit, rename, delete, duplicate, undo, save and load."""

from collections.abc import Callable
from pathlib import Path
from random import Random

import bmesh
import bpy

from tests.blender.random_steps import cast
from tests.blender.random_steps.options import TEXTS, value_of

MODES = ["EDIT", "EDIT", "SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT", "TEXTURE_PAINT", "OBJECT"]
MODIFIERS = ["MIRROR", "SUBSURF", "SOLIDIFY", "TRIANGULATE", "MULTIRES", "DISPLACE", "ARMATURE"]
# A file may not grow beyond what can be compared in no time.
MOST_OBJECTS, MOST_FACES = 20, 600


def meshes() -> list[bpy.types.Object]:
    """Return the mesh objects of the view layer, without the dots of a complex."""
    return [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH" and "eigenparts_role" not in obj]


def leave_mode() -> None:
    """Put all objects into object mode; others than the active one may be edited, too."""
    objects = bpy.context.view_layer.objects
    active = objects.active
    for obj in [obj for obj in objects if obj.mode != "OBJECT"]:
        objects.active = obj
        if bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode="OBJECT")
    objects.active = active


def tidy(chance: Random) -> None:
    """Keep the scene small, but never without a mesh."""
    if len(bpy.data.objects) > MOST_OBJECTS:
        leave_mode()
        _remove(chance.sample(list(bpy.data.objects), len(bpy.data.objects) - MOST_OBJECTS + 6))
    _remove([obj for obj in bpy.data.objects if obj.type == "MESH" and len(obj.data.polygons) > MOST_FACES])
    while sum(len(obj.data.polygons) > 50 for obj in meshes()) < 3:
        leave_mode()
        cast.add_shape(chance.choice(["body", "star", "two", "ring"]), chance)


def _remove(objects: list[bpy.types.Object]) -> None:
    """Remove objects with what only they use."""
    if objects:
        bpy.data.batch_remove(objects)
        bpy.data.orphans_purge(do_recursive=True)
        # Without this the view layer lists what is gone.
        bpy.context.view_layer.update()


def add(chance: Random) -> str:
    if chance.random() < 0.2:
        return f"adds {cast.add_other(chance.choice(sorted(cast.OTHERS))).name}"
    return f"adds {cast.add_shape(chance.choice(sorted(cast.SHAPES)), chance).name}"


def edit(chance: Random) -> str:
    obj = chance.choice(meshes())
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    name = chance.choice(sorted(EDITS))
    EDITS[name](edited, chance)
    edited.to_mesh(obj.data)
    edited.free()
    obj.data.update()
    return f"{name} of {obj.name}"


def _move_vertices(edited: bmesh.types.BMesh, chance: Random) -> None:
    for vertex in list(edited.verts)[:: chance.choice([1, 7, 50])]:
        vertex.co.z += chance.choice([0.01, 0.01, 0.5, 1e9, float("nan")])


def _delete_faces(edited: bmesh.types.BMesh, chance: Random) -> None:
    doomed = [face for face in edited.faces if chance.random() < chance.choice([0.01, 0.1, 1])]
    bmesh.ops.delete(edited, geom=doomed, context="FACES")


def _subdivide(edited: bmesh.types.BMesh, chance: Random) -> None:
    bmesh.ops.subdivide_edges(edited, edges=list(edited.edges)[:6], cuts=1, use_grid_fill=True)


def _flip_faces(edited: bmesh.types.BMesh, chance: Random) -> None:
    bmesh.ops.reverse_faces(edited, faces=[face for face in edited.faces if chance.random() < 0.3])


def _dissolve_faces(edited: bmesh.types.BMesh, chance: Random) -> None:
    bmesh.ops.dissolve_faces(edited, faces=list(edited.faces)[:2])


def _add_loose_vertex(edited: bmesh.types.BMesh, chance: Random) -> None:
    edited.verts.new((9, 9, 9))


def _split_vertices(edited: bmesh.types.BMesh, chance: Random) -> None:
    bmesh.ops.split_edges(edited, edges=[edge for edge in edited.edges if chance.random() < 0.2])


def _triangulate(edited: bmesh.types.BMesh, chance: Random) -> None:
    bmesh.ops.triangulate(edited, faces=list(edited.faces))


EDITS = {
    action.__name__.strip("_").replace("_", " "): action
    for action in (
        *(_move_vertices, _delete_faces, _subdivide, _flip_faces),
        *(_dissolve_faces, _add_loose_vertex, _split_vertices, _triangulate),
    )
}


def change_history(chance: Random) -> str:
    name = chance.choice(["undo", "undo", "redo"])
    return f"presses {name}: {in_window(getattr(bpy.ops.ed, name))}"


def push_undo() -> None:
    """Make what is there one step of undo."""
    in_window(bpy.ops.ed.undo_push, message="step")


def in_window(operator: Callable[..., set[str]], **options: object) -> str:
    """Call an operator of Blender's that needs a window, and return what became of it."""
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen):
        try:
            return next(iter(operator(**options)))
        except RuntimeError:
            return "refused"


def save_and_load(folder: Path) -> None:
    """Save to a file and open it."""
    path = str(folder / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False)
    bpy.ops.wm.open_mainfile(filepath=path)


def change_mode(chance: Random) -> str:
    obj, mode = chance.choice(meshes()), chance.choice(MODES)
    cast.select(obj)
    if not bpy.ops.object.mode_set.poll():
        return "cannot change the mode"
    try:
        bpy.ops.object.mode_set(mode=mode)
    except RuntimeError:
        # Blender's own refusal, as of a sculpt mode that the mesh cannot have.
        return f"{obj.name} is refused {mode}"
    return f"{obj.name} in {mode}"


def change_selection(chance: Random) -> str:
    some = chance.sample(list(bpy.context.view_layer.objects), chance.choice([0, 1, 2, 2]))
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in some)
    active = chance.choice([None, *bpy.context.view_layer.objects])
    bpy.context.view_layer.objects.active = active
    return f"makes {active.name if active else None} active"


def select_faces(chance: Random) -> str:
    obj, share = chance.choice(meshes()), chance.choice([0, 0.1, 0.5])
    select_some_faces(obj.data, share, chance)
    return f"selects {share:.0%} of {obj.name}"


def select_some_faces(mesh: bpy.types.Mesh, share: float, chance: Random) -> None:
    """Select a share of the faces of a mesh."""
    mesh.polygons.foreach_set("select", [chance.random() < share for _ in mesh.polygons])
    mesh.update()


def rename(chance: Random) -> str:
    obj, name = chance.choice(list(bpy.data.objects)), chance.choice(TEXTS)
    old, obj.name = obj.name, name
    if obj.data is not None:
        obj.data.name = chance.choice(TEXTS)
    return f"renames {old} to {obj.name}"


def delete(chance: Random) -> str:
    obj = chance.choice(list(bpy.data.objects))
    name = obj.name
    _remove([obj])
    return f"deletes {name}"


def duplicate(chance: Random) -> str:
    obj, is_linked = chance.choice(meshes()), chance.random() < 0.5
    copy = obj.copy()
    if not is_linked:
        copy.data = obj.data.copy()
    bpy.context.collection.objects.link(copy)
    cast.select(copy)
    return f"duplicates {obj.name} as {copy.name}{', linked' if is_linked else ''}"


def transform(chance: Random) -> str:
    obj = chance.choice(list(bpy.data.objects))
    obj.scale = [chance.choice([1, 1, -1, 2, 0, 1e-4]) for _ in range(3)]
    obj.rotation_euler.z = chance.random()
    if chance.random() < 0.3:
        parent = chance.choice(list(bpy.data.objects))
        # Blender refuses loops by itself, in its own log.
        obj.parent = parent if parent != obj and parent.parent is None and not obj.children else None
    return f"scales {obj.name} by {tuple(obj.scale)}"


def hide(chance: Random) -> str:
    obj = chance.choice(list(bpy.context.view_layer.objects))
    how = chance.choice(["show", "show", "eye", "viewports"])
    obj.hide_set(how == "eye")
    obj.hide_viewport = how == "viewports"
    return f"hides {obj.name}: {how}"


def add_modifier(chance: Random) -> str:
    obj, kind = chance.choice(meshes()), chance.choice(MODIFIERS)
    obj.modifiers.new("mine", kind)
    return f"gives {obj.name} a modifier {kind}"


def change_layers(chance: Random) -> str:
    """Add, remove or overwrite layers, those of ours too."""
    obj = chance.choice(meshes())
    attributes = obj.data.attributes
    name = chance.choice([*attributes.keys(), *cast.LAYERS, *cast.CLASHING])
    if name not in attributes:
        cast.add_layer(obj.data, name, chance)
        return f"adds layer {name} to {obj.name}"
    if attributes[name].is_required or name.startswith((".edge_verts", ".corner_")):
        return f"leaves layer {name} of {obj.name}"
    if attributes[name].data_type == "INT" and len(attributes[name].data) and chance.random() < 0.5:
        attributes[name].data[0].value = chance.choice([0, 1, 7, -3, 2**31 - 1])
        return f"changes layer {name} of {obj.name}"
    attributes.remove(attributes[name])
    return f"removes layer {name} of {obj.name}"


def change_groups(chance: Random) -> str:
    obj = chance.choice(meshes())
    if len(obj.vertex_groups) and chance.random() < 0.4:
        group = chance.choice(list(obj.vertex_groups))
        name = group.name
        obj.vertex_groups.remove(group)
        return f"removes group {name} of {obj.name}"
    group = obj.vertex_groups.new(name=chance.choice(["grip", "Part 1", "Body"]))
    group.add(list(range(0, len(obj.data.vertices), 2)), chance.random(), "REPLACE")
    group.lock_weight = chance.random() < 0.2
    return f"adds group {group.name} to {obj.name}"


def change_materials(chance: Random) -> str:
    obj = chance.choice(meshes())
    if len(obj.data.materials) and chance.random() < 0.4:
        obj.data.materials.pop(index=chance.randrange(len(obj.data.materials)))
        return f"removes a slot of {obj.name}"
    obj.data.materials.append(chance.choice([None, *bpy.data.materials]))
    return f"adds a slot to {obj.name}"


def change_keys(chance: Random) -> str:
    obj = chance.choice(meshes())
    if obj.data.shape_keys and chance.random() < 0.3:
        obj.shape_key_clear()
        return f"removes the shape keys of {obj.name}"
    key = obj.shape_key_add(name=chance.choice(["Basis", "wide", "long"]))
    key.value = chance.random()
    return f"adds shape key {key.name} to {obj.name}"


def change_options(chance: Random) -> str:
    """Set an option of the panel that belongs to the scene."""
    group = getattr(bpy.context.scene, chance.choice(["eigenparts", "eigenparts_skeleton", "eigenparts_transfer"]))
    declared = chance.choice([one for one in group.bl_rna.properties if one.type != "POINTER" and not one.is_readonly])
    if declared.identifier == "name":
        return "sets nothing"
    return set_property(group, declared, chance)


def set_property(group: bpy.types.PropertyGroup, declared: bpy.types.Property, chance: Random) -> str:
    """Set a property to a value that may be out of range."""
    value = value_of(declared, chance, chance.random() < 0.7)
    setattr(group, declared.identifier, set(value) if getattr(declared, "is_enum_flag", False) else value)
    return f"sets {declared.identifier} to {value}"


# By how often they are done.
ACTIONS = {
    action.__name__.replace("_", " "): action
    for action in (
        *(add, edit, change_history, change_mode, change_selection, select_faces, rename, delete, duplicate, transform),
        *(hide, add_modifier, change_layers, change_groups, change_materials, change_keys, change_options),
    )
}
# Those that are done in any mode.
ANYWHERE = {"change history", "change mode", "change options"}
