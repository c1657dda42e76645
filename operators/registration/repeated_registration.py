"""Base class of the operators that register one object once more.

What was computed before is used as long as Blender runs; functions are not stored in files, so the first time after a
file was loaded both meshes are analyzed again.
"""

from collections.abc import Callable
from typing import Any

import bpy

from ...tasks.match_options import MatchOptions
from ...tasks.refusals import Refusal
from ...tasks.shape_registration import Registration
from ..blender.known_values import mesh_of, present
from ..blender.registered_settings import analysis_settings
from ..blender.typed_properties import StringProperty, TypedProperties
from ..jobs import background
from ..mesh_state import registration_record
from ..mesh_state.state import read
from ..messages.user_errors import can_use_active_mesh
from ..parts.analysis_settings import SETTINGS, AnalysisSettings
from .registration_operator import RegistrationHandles, RegistrationOperator

# Options that a registration of 0.1.0 does not know, as it was made.
NOT_IN_0_1_0 = {"borders": AnalysisSettings().borders}
DAMAGED = "The registration stored on this mesh is damaged; register the selected meshes again."


class RepeatedRegistration(TypedProperties, RegistrationOperator):
    """Registers one object again as before, but for what ``match_options`` says."""

    object_name: str = StringProperty(name="Object", description="Name of the object; the active one if empty")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return background.can_start_job(cls) and can_use_active_mesh(cls, context)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., Registration], RegistrationHandles]:
        obj = _mesh_object(context, self.object_name) if self.object_name else present(context.object)
        registration = read(mesh_of(obj)).registration
        match = None if registration is None else registration.match
        if registration is None or match is None:
            raise Refusal(registration_record.NOT_REGISTERED)
        reference = registration.reference or _mesh_object(context, match.reference)
        if reference.name not in present(context.view_layer).objects:
            raise Refusal(f'"{reference.name}", whose parts it has, is not in this view layer any more.')
        stored = NOT_IN_0_1_0 | match.settings
        if not _are_settings(stored, analysis_settings(context).bl_rna.properties):
            raise Refusal(DAMAGED)
        settings = AnalysisSettings(**{name: stored[name] for name in SETTINGS})
        return self.start(context, reference, [obj], self.match_options(match), settings)

    def match_options(self, match: registration_record.Match) -> MatchOptions:
        """Return the options of the new matching."""
        raise NotImplementedError


def _are_settings(stored: dict[str, Any], known: "bpy.types.bpy_prop_collection[bpy.types.Property]") -> bool:
    """Whether what is stored can be the options of an analysis."""
    return all(name in stored and _can_be(stored[name], known[name]) for name in SETTINGS)


def _can_be(value: Any, option: bpy.types.Property) -> bool:
    if isinstance(option, bpy.types.EnumProperty):
        return isinstance(value, str) and value in option.enum_items
    if option.type == "STRING":
        return isinstance(value, str)
    # Blender may give truth back as a number.
    return isinstance(value, int) and option.type in ("INT", "BOOLEAN") and value >= getattr(option, "hard_min", 0)


def _mesh_object(context: bpy.types.Context, name: str) -> bpy.types.Object:
    obj = present(context.view_layer).objects.get(name)
    if obj is None or obj.type != "MESH":
        raise Refusal(f'There is no mesh object "{name}" here any more; register the selected meshes again.')
    return obj
