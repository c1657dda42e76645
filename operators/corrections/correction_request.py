"""Base class of the operators that correct the parts of the active mesh by hand."""

from __future__ import annotations

from typing import Any

import bpy

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of
from ..blender.mixins import OperatorMixin
from ..blender.outcome import Outcome
from ..blender.registered_settings import mesh_settings
from ..mesh_state import corrected_analysis
from ..mesh_state.state import MeshState, is_analyzed_for, read
from ..messages.user_errors import can_use_active_mesh, refusals_told
from ..parts.select import PART_PROPERTY, use_active_part

BODY_IS_WHAT_IS_LEFT = "The body is what the parts leave; change the parts next to it instead."


class CorrectsParts(OperatorMixin):
    """Corrects the parts of the active mesh; operators give ``correct``."""

    bl_options = {"REGISTER", "UNDO"}
    # Whether the part's twin is corrected, too; of operators that have this property.
    mirror: bool

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            state = read(mesh_of(context.object))
            corrected_analysis.refuse_uncorrectable(state)
            self.fill_in(state)
            self.correct(state)
            return {"FINISHED"}
        return {"CANCELLED"}

    def fill_in(self, state: MeshState) -> None:
        """Set what the call leaves open."""
        if PART_PROPERTY in self.properties.bl_rna.properties:
            use_active_part(self, state.mesh)
        if "mirror" in self.properties.bl_rna.properties and not self.properties.is_property_set("mirror"):
            self.mirror = mesh_settings(state.mesh).mirror

    def correct(self, state: MeshState) -> None:
        """Change the corrections of a mesh."""
        raise NotImplementedError


def refuse_absent(state: MeshState, *parts: int) -> None:
    """Raise a Refusal if a mesh does not show some parts."""
    for part in parts:
        if part not in state.summary.shares:
            raise Refusal(f"There is no part {part} at this level.")


def new_item(state: MeshState, kind: str, part: int, **values: Any) -> compute.Correction:
    """Return a correction that is made on what a mesh shows now."""
    return compute.Correction(kind, part, **values, level=state.level, mode=state.mode)
