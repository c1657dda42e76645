"""The tick boxes of the outputs among the settings of a mesh, made from the registry."""

from typing import Any

from ..blender.known_values import mesh_with
from ..blender.mixins import GroupMixin
from ..blender.typed_properties import BoolProperty, FloatProperty, TypedProperties
from ..mesh_state.state import read
from ..outputs import part_writer
from ..outputs.output import Output
from ..outputs.output_registry import OUTPUTS, chosen
from .panel_problems import shown_in_panel


def _tick_box(output: Output) -> Any:
    """Return a property that writes an output when it is ticked, and takes it back."""

    def is_chosen(settings: "OutputSettings") -> bool:
        return output in chosen(read(mesh_with(settings)).outputs)

    @shown_in_panel
    def choose(settings: "OutputSettings", is_wanted: bool) -> None:
        part_writer.choose_output(mesh_with(settings), output.key, is_wanted)

    return BoolProperty(name=output.name, description=output.description, get=is_chosen, set=choose)


def _softness(settings: "OutputSettings") -> float:
    return read(mesh_with(settings)).softness


@shown_in_panel
def _set_softness(settings: "OutputSettings", width: float) -> None:
    part_writer.write_outputs(mesh_with(settings), softness=width)


class OutputSettings(TypedProperties, GroupMixin):
    """The outputs that a mesh is to have."""

    softness: float = FloatProperty(
        name="Softness",
        description="Width over which vertex groups pass from one part to the next; 0 for hard borders",
        subtype="DISTANCE",
        min=0,
        get=_softness,
        set=_set_softness,
    )


OutputSettings.__annotations__ |= {output.property_name: _tick_box(output) for output in OUTPUTS.values()}
