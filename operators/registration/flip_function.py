"""Operator: register an object again with the other sign of one matched function."""

import bpy

from ...tasks.match_options import MatchOptions
from ...tasks.refusals import Refusal
from ..blender.typed_properties import IntProperty, TypedProperties
from ..mesh_state.registration_record import Match, remembered_options
from .mesh_registration import SHOWN_FUNCTIONS
from .repeated_registration import RepeatedRegistration


class EIGENPARTS_OT_flip_function(RepeatedRegistration, TypedProperties, bpy.types.Operator):
    """Registers the object again with the other sign of one of the attributes that Write Eigenfunctions makes."""

    bl_idname = "eigenparts.flip_function"
    bl_label = "Flip Function"
    bl_description = (
        "Register the object again with the other sign of this function, whatever fits better; "
        "Write Eigenfunctions makes attributes of these functions"
    )
    bl_options = {"UNDO"}

    number: int = IntProperty(
        name="Function",
        description="Which function of the reference, counted from the smoothest",
        default=1,
        min=1,
        max=SHOWN_FUNCTIONS,
    )

    def match_options(self, match: Match) -> MatchOptions:
        if self.number > len(match.signs):
            raise Refusal(f"Function {self.number} was not matched; there are {len(match.signs)}.")
        flips = {**remembered_options(match).flips, self.number: -match.signs[self.number - 1]}
        return MatchOptions(flips, mirrored=match.mirrored)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_flip_function,))
