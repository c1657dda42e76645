"""Operator: divide an analyzed mesh into parts at another level."""

import bpy

from ... import compute
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.typed_properties import BoolProperty, EnumProperty, FloatProperty, IntProperty, TypedProperties
from ..mesh_data.viewport import show_vertex_colours
from ..mesh_state.state import is_analyzed_for, read
from ..messages.sentences import tell
from ..messages.user_errors import can_use_active_mesh, refusals_told
from ..outputs import part_writer
from .choice_items import JOINTS, MODE_ITEMS, identifier, word

# What a division can go by, and the property that says how far.
MEASURES = {"LEVEL": "level", "N_PARTS": "n_parts", "THRESHOLD": "threshold"}


class EIGENPARTS_OT_segment(TypedProperties, bpy.types.Operator):
    """Divide the analyzed mesh into parts: by level, threshold or number, or at the default level"""

    bl_idname = "eigenparts.segment"
    bl_label = "Segment"
    bl_options = {"REGISTER", "UNDO"}

    by: str = EnumProperty(
        name="By",
        description="What says how finely the mesh is divided; if not given, what is given of the following",
        items=[
            ("DEFAULT", "Default Level", "The level that the analysis finds best"),
            ("LEVEL", "Level", "So many of the most prominent features"),
            ("N_PARTS", "Number of Parts", "So many parts, the body included"),
            ("THRESHOLD", "Threshold", "All features that are high enough"),
        ],
        options={"SKIP_SAVE"},
    )
    level: int = IntProperty(name="Level", description="How many features to keep", soft_min=0, options={"SKIP_SAVE"})
    threshold: float = FloatProperty(
        name="Threshold",
        description="Least height of a feature, as a fraction of the field's range",
        default=0.05,
        soft_min=0,
        soft_max=1,
        options={"SKIP_SAVE"},
    )
    n_parts: int = IntProperty(
        name="Parts", description="How many parts, the body included", soft_min=1, options={"SKIP_SAVE"}
    )
    mode: str = EnumProperty(
        name="Mode",
        description="What becomes a part; if not given, as it is on the mesh",
        items=MODE_ITEMS,
        options={"SKIP_SAVE"},
    )
    joints: bool = BoolProperty(name="Joints", description=JOINTS, options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and is_analyzed_for(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = present(self.layout)
        layout.use_property_split = True
        layout.prop(self, "mode")
        layout.prop(self, "joints")
        layout.prop(self, "by")
        if self.by in MEASURES:
            layout.prop(self, MEASURES[self.by])

    def execute(self, context: bpy.types.Context) -> Outcome:
        state, given = read(mesh_of(context.object)), self._given()
        with refusals_told(self):
            mode = self._reading(state.mode)
            labels = part_writer.segment(state, mode=mode, **{name: getattr(self, name) for name in given})
            show_vertex_colours(context)
            for warning in labels.warnings:
                tell(self, "WARNING", warning)
            self._fill_in(labels, mode, given)
            return {"FINISHED"}
        return {"CANCELLED"}

    def _reading(self, shown: str) -> str:
        """Return how levels are to be read: as they are shown, where nothing else is given."""
        is_given = self.properties.is_property_set
        mode = word(compute.MODES, self.mode) if is_given("mode") else compute.mode_of(shown)
        if mode != compute.NESTED and is_given("mode"):
            # The tick is what the panel of the last operation still holds.
            return mode
        kept = False if shown == compute.NESTED else None
        return compute.reading_of(mode, self.joints if is_given("joints") else kept)

    def _given(self) -> list[str]:
        """Return what the division goes by: what was chosen, or all that is given."""
        if self.properties.is_property_set("by"):
            return [MEASURES[self.by]] if self.by in MEASURES else []
        return [name for name in MEASURES.values() if self.properties.is_property_set(name)]

    def _fill_in(self, labels: "compute.BranchLabels", mode: str, given: list[str]) -> None:
        """Let the panel of the last operation begin with what the mesh shows."""
        self.by = next((by for by, name in MEASURES.items() if name in given), "DEFAULT")
        self.mode, self.joints = identifier(compute.mode_of(mode)), mode == compute.JOINTED
        for name, value in (("level", labels.level), ("n_parts", len(labels.parts))):
            if name not in given:
                setattr(self, name, value)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_segment,))
