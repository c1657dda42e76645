"""Operator: give the selected faces to a part."""

import bpy
import numpy as np
from bpy.props import BoolProperty, IntProperty

from ... import compute
from ..mesh_state import corrected_analysis, corrections, state
from ..messages.user_errors import Refusal, can_use_active_mesh, is_linked
from ..outputs import part_writer
from ..parts.select import selected_faces
from .correction_request import CorrectsParts, new_item, refuse_absent


class EIGENPARTS_OT_paint_part(CorrectsParts, bpy.types.Operator):
    """Give the selected faces to a part, or make a part of them; edit mode is left, so that the result is seen"""

    bl_idname = "eigenparts.paint_part"
    bl_label = "Assign Selected Faces"

    part: IntProperty(name="Part", description="Number of the part, 0 for the body; the active one if not given", min=0)
    new: BoolProperty(name="New Part", description="Make a new part of the faces", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # Faces are selected in edit mode, so the action is offered there too.
        is_edited = context.mode == "EDIT_MESH" and not is_linked(context.object.data)
        return (is_edited or can_use_active_mesh(cls, context)) and state.is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        if context.mode == "EDIT_MESH":
            bpy.ops.object.mode_set(mode="OBJECT")
        return super().execute(context)

    def fill_in(self, mesh: bpy.types.Mesh) -> None:
        if not self.new:
            super().fill_in(mesh)

    def correct(self, mesh: bpy.types.Mesh) -> None:
        faces = selected_faces(mesh)
        if self.new:
            paint_new_part(mesh, faces)
        else:
            paint_part(mesh, self.part, faces)


def paint_part(mesh: bpy.types.Mesh, part: int, faces: np.ndarray) -> None:
    """Give some faces (F,) to a part that the mesh shows."""
    refuse_absent(mesh, part)
    items = corrected_analysis.items_of(mesh)
    own = next((item.other for item in items if item.kind == compute.PAINT and item.part == part), 0)
    _paint(mesh, items, new_item(mesh, compute.PAINT, part, other=own), faces)


def paint_new_part(mesh: bpy.types.Mesh, faces: np.ndarray) -> None:
    """Make a part of some faces (F,)."""
    items = corrected_analysis.items_of(mesh)
    part = corrected_analysis.free_part(state.load(mesh).part_tree.hierarchy, items)
    _paint(mesh, items, new_item(mesh, compute.PAINT, part, other=1), faces)


def _paint(
    mesh: bpy.types.Mesh, items: tuple["compute.Correction", ...], new: "compute.Correction", faces: np.ndarray
) -> None:
    if not faces.any():
        raise Refusal("Select the faces first that the part is to have.")
    painted = np.where(faces, new.part, corrections.read_painted(mesh))
    is_known = any((item.kind, item.part) == (compute.PAINT, new.part) for item in items)
    _repaint(mesh, items if is_known else (*items, new), painted)


def repaint(mesh: bpy.types.Mesh, painted: np.ndarray) -> None:
    """Paint the faces (F,) of a mesh with parts that it shows, -1 for none."""
    items = corrected_analysis.items_of(mesh)
    known = {item.part for item in items if item.kind == compute.PAINT}
    new = [new_item(mesh, compute.PAINT, part) for part in np.unique(painted).tolist() if part >= 0]
    _repaint(mesh, (*items, *(item for item in new if item.part not in known)), painted)


def _repaint(mesh: bpy.types.Mesh, items: tuple["compute.Correction", ...], painted: np.ndarray) -> None:
    # A part whose last painted face was painted over is painted no more.
    left = set(painted.tolist())
    kept = tuple(item for item in items if item.kind != compute.PAINT or item.part in left)
    part_writer.correct_mesh(mesh, kept, painted=painted)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_paint_part,))
