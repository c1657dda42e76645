"""Operator: give the selected faces to a part."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of
from ..blender.outcome import Outcome
from ..blender.typed_properties import BoolProperty, IntProperty, TypedProperties
from ..mesh_state import corrected_analysis
from ..mesh_state.state import MeshState, is_analyzed_for
from ..messages.user_errors import can_use_active_mesh, is_linked
from ..outputs import part_writer
from ..parts.select import selected_faces
from .correction_request import CorrectsParts, new_item, refuse_absent


class EIGENPARTS_OT_paint_part(CorrectsParts, TypedProperties, bpy.types.Operator):
    """Give the selected faces to a part, or make a part of them; edit mode is left, so that the result is seen"""

    bl_idname = "eigenparts.paint_part"
    bl_label = "Assign Selected Faces"

    part: int = IntProperty(
        name="Part", description="Number of the part, 0 for the body; the active one if not given", min=0
    )
    new: bool = BoolProperty(name="New Part", description="Make a new part of the faces", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # Faces are selected in edit mode, so the action is offered there too.
        is_edited = context.mode == "EDIT_MESH" and not is_linked(mesh_of(context.object))
        return (is_edited or can_use_active_mesh(cls, context)) and is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        if context.mode == "EDIT_MESH":
            bpy.ops.object.mode_set(mode="OBJECT")
        return super().execute(context)

    def fill_in(self, state: MeshState) -> None:
        if not self.new:
            super().fill_in(state)

    def correct(self, state: MeshState) -> None:
        faces = selected_faces(state.mesh)
        if self.new:
            paint_new_part(state, faces)
        else:
            paint_part(state, self.part, faces)


def paint_part(state: MeshState, part: int, faces: NDArray[np.bool_]) -> None:
    """Give some faces (F,) to a part that the mesh shows."""
    refuse_absent(state, part)
    items = (item for item in state.corrections if item.kind == compute.PAINT and item.part == part)
    is_all_painted = next((item.other for item in items), 0)
    _paint(state, new_item(state, compute.PAINT, part, other=is_all_painted), faces)


def paint_new_part(state: MeshState, faces: NDArray[np.bool_]) -> None:
    """Make a part of some faces (F,)."""
    part = corrected_analysis.free_part(state)
    _paint(state, new_item(state, compute.PAINT, part, other=1), faces)


def repaint(state: MeshState, painted: NDArray[np.int64]) -> None:
    """Paint the faces (F,) of a mesh with parts that it shows, -1 for none."""
    known = {item.part for item in state.corrections if item.kind == compute.PAINT}
    new = [new_item(state, compute.PAINT, part) for part in np.unique(painted).tolist() if part >= 0]
    _repaint(state, (*state.corrections, *(item for item in new if item.part not in known)), painted)


def _paint(state: MeshState, new: "compute.Correction", faces: NDArray[np.bool_]) -> None:
    if not faces.any():
        raise Refusal("Select the faces first that the part is to have.")
    painted = np.where(faces, new.part, state.painted)
    is_known = any((item.kind, item.part) == (compute.PAINT, new.part) for item in state.corrections)
    _repaint(state, state.corrections if is_known else (*state.corrections, new), painted)


def _repaint(state: MeshState, items: tuple["compute.Correction", ...], painted: NDArray[np.int64]) -> None:
    # A part whose last painted face was painted over is painted no more.
    left = set(painted.tolist())
    kept = tuple(item for item in items if item.kind != compute.PAINT or item.part in left)
    part_writer.correct(state, kept, painted=painted)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_paint_part,))
