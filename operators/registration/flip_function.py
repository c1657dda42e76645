"""Operator: register an object again with the other sign of one matched function."""

import bpy
from bpy.props import IntProperty

from ..mesh_state.registration_record import Match
from ..messages.user_errors import Refusal
from .register_meshes import SHOWN_FUNCTIONS, Wish
from .registering_again import RegistersAgain, given_flips


class EIGENPARTS_OT_flip_function(RegistersAgain, bpy.types.Operator):
    """Registers the object again with the other sign of one of the attributes that Write Eigenfunctions makes."""

    bl_idname = "eigenparts.flip_function"
    bl_label = "Flip Function"
    bl_description = (
        "Register the object again with the other sign of this function, whatever fits better; "
        "Write Eigenfunctions makes attributes of these functions"
    )
    bl_options = {"UNDO"}

    number: IntProperty(
        name="Function",
        description="Which function of the reference, counted from the smoothest",
        default=1,
        min=1,
        max=SHOWN_FUNCTIONS,
    )

    def wish(self, match: Match) -> Wish:
        if self.number > len(match.signs):
            raise Refusal(f"Function {self.number} was not matched; there are {len(match.signs)}.")
        sign = -match.signs[self.number - 1]
        return Wish(flips={**given_flips(match), self.number: sign}, mirrored=match.mirrored)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_flip_function,))
