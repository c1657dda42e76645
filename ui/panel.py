"""Sidebar tab: analyze, move the level, look at the parts."""

import bpy

from ..operators import state

# More rows than this would push everything else out of sight.
MOST_ROWS = 24


class EigenpartsPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenparts"


class EIGENPARTS_PT_analyze(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Analyze"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        status = context.window_manager.eigenparts
        if status.is_running:
            row = layout.row(align=True)
            row.progress(factor=status.fraction, text=status.text)
            row.operator("eigenparts.cancel", text="", icon="X")
        else:
            _draw_options(layout, context)
            layout.operator("eigenparts.analyze", icon="MOD_EXPLODE")


class EIGENPARTS_PT_parts(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Parts"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _is_analyzed(context)

    def draw(self, context: bpy.types.Context) -> None:
        mesh = context.object.data
        try:
            summary = state.summarize(mesh)
        except state.Refusal as refusal:
            _draw_sentence(self.layout, str(refusal), context.region.width)
        else:
            _draw_level(self.layout, mesh, summary)
            _draw_parts(self.layout, mesh)
        status = context.window_manager.eigenparts
        if status.problem and status.problem_of == mesh.name_full:
            _draw_sentence(self.layout, status.problem, context.region.width)
        self.layout.operator("eigenparts.clear", icon="TRASH")


class EIGENPARTS_PT_outputs(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Output"
    bl_parent_id = "EIGENPARTS_PT_parts"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.object.data.eigenparts
        column = self.layout.column(heading="")
        for name in ("vertex_attribute", "corner_colors", "face_sets", "vertex_groups"):
            column.prop(settings, name)
        softness = column.row()
        softness.active = settings.vertex_groups
        softness.prop(settings, "softness")
        column.prop(settings, "materials")
        column.prop(settings, "field")
        column.operator("eigenparts.write_eigenfunctions", text="Eigenfunctions")
        column = self.layout.column(align=True)
        cuts = column.row(align=True)
        cuts.operator("eigenparts.cut", icon="MOD_BOOLEAN").method = "INSERT"
        cuts.operator("eigenparts.cut", text="Use Edges").method = "EXISTING"
        column.operator("eigenparts.separate", icon="MOD_EXPLODE")


def _is_analyzed(context: bpy.types.Context) -> bool:
    obj = context.object
    return obj is not None and obj.type == "MESH" and state.is_analyzed(obj.data)


def _draw_options(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    settings = context.scene.eigenparts
    layout.prop(settings, "field")
    if settings.field == "EIGENFUNCTION":
        layout.prop(settings, "eigenfunction")
    if settings.field == "ATTRIBUTE":
        layout.prop(settings, "attribute")
    layout.prop(settings, "order")
    layout.prop(settings, "boundary")
    layout.prop(settings, "use_modifiers")


def _draw_level(layout: bpy.types.UILayout, mesh: bpy.types.Mesh, summary: state.Summary) -> None:
    layout.label(text=f"{summary.description}, levels 0 to {summary.n_levels - 1}")
    layout.row().prop(mesh.eigenparts, "mode", expand=True)
    column = layout.column(align=True)
    column.prop(mesh.eigenparts, "level")
    column.prop(mesh.eigenparts, "n_parts")
    column.operator("eigenparts.segment", text="Default Level", icon="LOOP_BACK")


def _draw_parts(layout: bpy.types.UILayout, mesh: bpy.types.Mesh) -> None:
    settings = mesh.eigenparts
    layout.template_list("EIGENPARTS_UL_parts", "", settings, "rows", settings, "active_row", rows=6, maxrows=MOST_ROWS)


def _draw_sentence(layout: bpy.types.UILayout, sentence: str, width: int) -> None:
    """Draw a sentence in as many lines as the sidebar needs."""
    n_letters = max(20, int(width / (7 * bpy.context.preferences.system.ui_scale)))
    column = layout.column(align=True)
    column.alert = True
    line = ""
    for word in sentence.split():
        if len(line) + len(word) >= n_letters:
            column.label(text=line)
            line = ""
        line = f"{line} {word}".strip()
    column.label(text=line)


register, unregister = bpy.utils.register_classes_factory(
    (EIGENPARTS_PT_analyze, EIGENPARTS_PT_parts, EIGENPARTS_PT_outputs)
)
