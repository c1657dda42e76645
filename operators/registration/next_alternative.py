"""Operator: register an object again by the next best matching."""

from dataclasses import replace

import bpy

from ...tasks.match_options import MatchOptions
from ...tasks.refusals import Refusal
from ..mesh_state.registration_record import Match, remembered_options
from .repeated_registration import RepeatedRegistration


class EIGENPARTS_OT_next_alternative(RepeatedRegistration, bpy.types.Operator):
    """Register the object by the next best matching, after the last the best"""

    bl_idname = "eigenparts.next_alternative"
    bl_label = "Next Alternative"
    bl_options = {"UNDO"}

    def match_options(self, match: Match) -> MatchOptions:
        if match.n_alternatives == 0:
            raise Refusal("There is no other matching that fits.")
        return replace(remembered_options(match), alternative=match.alternative + 1)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_next_alternative,))
