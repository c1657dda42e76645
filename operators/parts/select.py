"""Operator: select the faces of a part for editing."""

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.attribute_types import Domain
from ...tasks.refusals import Refusal
from ..blender.known_values import elements_of, mesh_of, present
from ..blender.outcome import Outcome
from ..blender.registered_settings import mesh_settings
from ..blender.typed_properties import BoolProperty, IntProperty, TypedProperties
from ..mesh_data.mesh_arrays import read_own_integers
from ..messages.user_errors import can_use_active_mesh, refusals_told
from ..outputs.division import PART

# The property of operators that are about one part.
PART_PROPERTY = "part"


class EIGENPARTS_OT_select_part(TypedProperties, bpy.types.Operator):
    """Select the faces of a part and go to edit mode; with Shift, add them to the selection"""

    bl_idname = "eigenparts.select_part"
    bl_label = "Select Part"
    bl_options = {"REGISTER", "UNDO"}

    part: int = IntProperty(
        name="Part", description="Number of the part, 0 for the body; the active one if not given", min=0
    )
    extend: bool = BoolProperty(name="Extend", description="Keep what is selected already", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        self.extend = event.shift
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        mesh = mesh_of(context.object)
        with refusals_told(self):
            # The stubs take the call on an operator for one on its class.
            if not bpy.ops.object.mode_set.poll():  # type: ignore[call-arg]
                raise Refusal("The object is hidden; show it first.")
            use_active_part(self, mesh)
            is_selected = read_own_integers(mesh, PART) == self.part
            if not is_selected.any():
                raise Refusal(f"There is no part {self.part} at this level.")
            _select_faces(mesh, is_selected | selected_faces(mesh) if self.extend else is_selected)
            # The stubs take no plain values for an array.
            present(context.tool_settings).mesh_select_mode = (False, False, True)  # type: ignore[assignment]
            bpy.ops.object.mode_set(mode="EDIT")
            return {"FINISHED"}
        return {"CANCELLED"}


def use_active_part(operator: bpy.types.Operator, mesh: bpy.types.Mesh) -> None:
    """Let an operator be about the part that is active in the list if it was not told about which."""
    if not operator.properties.is_property_set(PART_PROPERTY):
        if mesh_settings(mesh).active_row < 0:
            raise Refusal("Click a part in the list first.")
        setattr(operator, PART_PROPERTY, mesh_settings(mesh).active_part)


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


def selected_faces(mesh: bpy.types.Mesh) -> NDArray[np.bool_]:
    """Mask (F,) of the selected faces of a mesh that is not in edit mode."""
    selection = np.empty(len(mesh.polygons), dtype=bool)
    mesh.polygons.foreach_get("select", selection)
    return selection


def _select_faces(mesh: bpy.types.Mesh, is_selected: NDArray[np.bool_]) -> None:
    """Select faces and nothing else; edit mode would grow the selection from vertices and edges left selected."""
    selections: tuple[tuple[str, Domain, NDArray[np.bool_]], ...] = (
        (".select_vert", "POINT", np.zeros(len(mesh.vertices), dtype=bool)),
        (".select_edge", "EDGE", np.zeros(len(mesh.edges), dtype=bool)),
        (".select_poly", "FACE", is_selected),
    )
    for name, domain, selection in selections:
        elements_of(_selection_attribute(mesh, name, domain)).foreach_set("value", selection)


def _selection_attribute(mesh: bpy.types.Mesh, name: str, domain: Domain) -> bpy.types.Attribute:
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.data_type != "BOOLEAN":
        # Blender 5.0 gives edges that a script made a selection of pairs of numbers, and crashes when it is used.
        mesh.attributes.remove(attribute)
        attribute = None
    return attribute or mesh.attributes.new(name, "BOOLEAN", domain)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_select_part,))
