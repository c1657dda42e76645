"""Operator: take all corrections back."""

import bpy
import numpy as np

from ..mesh_state.state import MeshState
from ..outputs import part_writer
from .correction_request import CorrectsParts


class EIGENPARTS_OT_clear_corrections(CorrectsParts, bpy.types.Operator):
    """Take all corrections by hand back"""

    bl_idname = "eigenparts.clear_corrections"
    bl_label = "Clear Corrections"

    def correct(self, state: MeshState) -> None:
        part_writer.correct(state, (), painted=np.full(len(state.mesh.polygons), -1))


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_clear_corrections,))
