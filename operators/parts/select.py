"""Operator: select the faces of a part for editing."""

import bmesh
import bpy
import numpy as np
from bpy.props import BoolProperty, IntProperty

from ..mesh_data.mesh_arrays import read_own_integers
from ..messages.user_errors import Refusal, can_use_active_mesh, refusals_told
from ..outputs.division import PART


class EIGENPARTS_OT_select_part(bpy.types.Operator):
    """Select the faces of a part and go to edit mode; with Shift, add them to the selection"""

    bl_idname = "eigenparts.select_part"
    bl_label = "Select Part"
    bl_options = {"REGISTER", "UNDO"}

    part: IntProperty(name="Part", description="Number of the part, 0 for the body; the active one if not given", min=0)
    extend: BoolProperty(name="Extend", description="Keep what is selected already", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.extend = event.shift
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.object.data
        with refusals_told(self):
            if not bpy.ops.object.mode_set.poll():
                raise Refusal("The object is hidden; show it first.")
            use_active_part(self, mesh)
            is_selected = read_own_integers(mesh, PART) == self.part
            if not is_selected.any():
                raise Refusal(f"There is no part {self.part} at this level.")
            _select_faces(mesh, is_selected | selected_faces(mesh) if self.extend else is_selected)
            context.tool_settings.mesh_select_mode = (False, False, True)
            bpy.ops.object.mode_set(mode="EDIT")
            return {"FINISHED"}
        return {"CANCELLED"}


def use_active_part(operator: bpy.types.Operator, mesh: bpy.types.Mesh) -> None:
    """Let an operator be about the part that is active in the list if it was not told about which."""
    if not operator.properties.is_property_set("part"):
        if mesh.eigenparts.active_row < 0:
            raise Refusal("Click a part in the list first.")
        operator.part = mesh.eigenparts.active_part


def select_faces_of(mesh: bpy.types.Mesh, part: int) -> None:
    """Select the faces of a part and nothing else, in the mode that the mesh is in."""
    if mesh.is_editmode:
        edited = bmesh.from_edit_mesh(mesh)
        layer = edited.faces.layers.int.get(PART.name)
        for face in edited.faces:
            face.select_set(layer is not None and face[layer] == part)
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    else:
        _select_faces(mesh, read_own_integers(mesh, PART) == part)
        mesh.update()


def selected_faces(mesh: bpy.types.Mesh) -> np.ndarray:
    """Tell which faces (F,) of a mesh that is not in edit mode are selected."""
    selection = np.empty(len(mesh.polygons), dtype=bool)
    mesh.polygons.foreach_get("select", selection)
    return selection


def _select_faces(mesh: bpy.types.Mesh, is_selected: np.ndarray) -> None:
    """Select faces and nothing else; edit mode would grow the selection from vertices and edges left selected."""
    for name, domain, selection in (
        (".select_vert", "POINT", np.zeros(len(mesh.vertices), dtype=bool)),
        (".select_edge", "EDGE", np.zeros(len(mesh.edges), dtype=bool)),
        (".select_poly", "FACE", is_selected),
    ):
        _selection_attribute(mesh, name, domain).data.foreach_set("value", selection)


def _selection_attribute(mesh: bpy.types.Mesh, name: str, domain: str) -> bpy.types.Attribute:
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.data_type != "BOOLEAN":
        # Blender 5.0 gives edges that a script made a selection of pairs of numbers, and crashes when it is used.
        mesh.attributes.remove(attribute)
        attribute = None
    return attribute or mesh.attributes.new(name, "BOOLEAN", domain)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_select_part,))
