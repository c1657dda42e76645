"""The meshes that a job takes from the active one to: what panels count and operators write to."""

import bpy


def other_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return one object for each selected mesh other than the active object's."""
    active = context.object.data if context.object is not None else None
    # Linked duplicates are one mesh, which is written to once.
    objects = {obj.data: obj for obj in context.selected_objects if obj.type == "MESH"}
    return [obj for mesh, obj in objects.items() if mesh != active]
