"""Operator: register an object again by the next best matching."""

import bpy

from ..mesh_state.registration_record import Match
from ..messages.user_errors import Refusal
from .register_meshes import Wish
from .registering_again import RegistersAgain, given_flips


class EIGENPARTS_OT_next_alternative(RegistersAgain, bpy.types.Operator):
    """Register the object by the next best matching, after the last the best"""

    bl_idname = "eigenparts.next_alternative"
    bl_label = "Next Alternative"
    bl_options = {"UNDO"}

    def wish(self, match: Match) -> Wish:
        if match.n_alternatives == 0:
            raise Refusal("There is no other matching that fits.")
        return Wish(given_flips(match), match.alternative + 1, match.mirrored)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_next_alternative,))
