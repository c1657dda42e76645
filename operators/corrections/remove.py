"""Operator: take one correction back."""

import bpy
import numpy as np

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.typed_properties import IntProperty, TypedProperties
from ..mesh_state.state import MeshState
from ..outputs import part_writer
from .correction_request import CorrectsParts


class EIGENPARTS_OT_remove_correction(CorrectsParts, TypedProperties, bpy.types.Operator):
    """Take this correction back; the others stay"""

    bl_idname = "eigenparts.remove_correction"
    bl_label = "Remove Correction"

    index: int = IntProperty(name="Correction", description="Its place in the list, from 0", min=0)

    def correct(self, state: MeshState) -> None:
        items = state.corrections
        if not 0 <= self.index < len(items):
            raise Refusal(f"There is no correction {self.index}; the mesh has {len(items)}.")
        removed, painted = items[self.index], state.painted
        if removed.kind == compute.PAINT:
            painted = np.where(painted == removed.part, -1, painted)
        part_writer.correct(state, items[: self.index] + items[self.index + 1 :], painted=painted)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_remove_correction,))
