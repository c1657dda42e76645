"""Sidebar tab: analyze, move the level, look at the parts, choose what they are written to."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ..operators.blender.known_values import present
from ..operators.blender.registered_settings import (
    AnalysisSettings,
    MeshSettings,
    analysis_settings,
    job_status,
    mesh_settings,
)
from ..operators.mesh_state.schema import ABSENT, DAMAGED
from ..operators.mesh_state.state import MeshState, is_analyzed, read
from ..operators.messages import unexpected_errors
from ..operators.outputs.output_registry import OUTPUTS
from .analysis_presets import EIGENPARTS_PT_analysis_presets
from .tab import NO_MESH, EigenpartsPanel, active_mesh, draw_hint, draw_sentence, main_row

# Rows of the list, always the same, so that nothing below it jumps when the level moves.
N_ROWS = 8
FIRST_STEP = "Press Analyze: what protrudes becomes parts, such as limbs and fingers. Then move the level."


class EIGENPARTS_PT_analyze(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Analyze"
    bl_order = 0

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        status = job_status(context)
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.enabled = not status.is_running
        _draw_field(column, analysis_settings(context), active_mesh(context))
        row = main_row(self, context)
        if row is not None:
            row.operator("eigenparts.analyze", icon="MOD_EXPLODE")
            row.operator("eigenparts.clear", text="", icon="TRASH")
        fault = unexpected_errors.last()
        if fault is not None:
            draw_sentence(layout, fault.sentence, present(context.region).width)
            layout.operator("eigenparts.copy_report", icon="COPYDOWN")


class EIGENPARTS_PT_options(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Options"
    bl_parent_id = "EIGENPARTS_PT_analyze"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        EIGENPARTS_PT_analysis_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.enabled = not job_status(context).is_running
        settings = analysis_settings(context)
        layout.prop(settings, "order")
        layout.prop(settings, "boundary")
        layout.prop(settings, "shells")
        layout.prop(settings, "borders")
        layout.prop(settings, "use_modifiers")


class EIGENPARTS_PT_level(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Level"
    bl_order = 10

    def draw(self, context: bpy.types.Context) -> None:
        layout, mesh = self.layout, active_mesh(context)
        if mesh is None:
            layout.label(text=NO_MESH)
            return
        state = read(mesh)
        if state.stored is None:
            draw_hint(layout, FIRST_STEP, present(context.region).width)
        else:
            layout.label(text=_origin_of_parts(state), translate=False)
        _draw_level(layout.column(), mesh)
        _draw_problems(layout, context, state)


class EIGENPARTS_PT_parts(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Parts"
    bl_order = 20

    def draw(self, context: bpy.types.Context) -> None:
        mesh = active_mesh(context)
        if mesh is None:
            self.layout.label(text=NO_MESH)
            return
        settings = mesh_settings(mesh)
        row = self.layout.row()
        row.template_list(
            *("EIGENPARTS_UL_parts", "", settings, "rows", settings, "active_row"), rows=N_ROWS, maxrows=N_ROWS
        )
        is_picking = job_status(context).is_picking
        row.operator("eigenparts.pick_part", text="", icon="EYEDROPPER", depress=is_picking)


class EIGENPARTS_PT_outputs(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Output"
    bl_order = 70
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        mesh = active_mesh(context)
        if mesh is None or not is_analyzed(mesh):
            self.layout.label(text=NO_MESH if mesh is None else ABSENT)
        if mesh is None:
            return
        column = self.layout.column()
        column.enabled = is_analyzed(mesh)
        _draw_outputs(column, mesh_settings(mesh))
        column = self.layout.column(align=True)
        cuts = column.row(align=True)
        present(cuts.operator("eigenparts.cut", icon="MOD_BOOLEAN")).method = "INSERT"
        present(cuts.operator("eigenparts.cut", text="Use Edges")).method = "EXISTING"
        column.operator("eigenparts.separate", icon="MOD_EXPLODE")


def _draw_field(layout: bpy.types.UILayout, settings: AnalysisSettings, mesh: bpy.types.Mesh | None) -> None:
    layout.prop(settings, "field")
    if settings.field == "EIGENFUNCTION":
        layout.prop(settings, "eigenfunction")
    if settings.field == "ATTRIBUTE" and mesh is None:
        layout.prop(settings, "attribute")
    elif settings.field == "ATTRIBUTE":
        layout.prop_search(settings, "attribute", mesh, "attributes")


def _draw_level(layout: bpy.types.UILayout, mesh: bpy.types.Mesh) -> None:
    layout.enabled = is_analyzed(mesh)
    settings = mesh_settings(mesh)
    layout.row().prop(settings, "mode", expand=True)
    joints = layout.row()
    joints.enabled = read(mesh).is_nested
    joints.prop(settings, "joints")
    column = layout.column(align=True)
    column.prop(settings, "level")
    column.prop(settings, "n_parts")
    column.operator("eigenparts.segment", text="Default Level", icon="LOOP_BACK")


def _draw_problems(layout: bpy.types.UILayout, context: bpy.types.Context, state: MeshState) -> None:
    """Say what is wrong with what the mesh remembers, and what the last change met."""
    status = job_status(context)
    if state.stored is not None and not state.is_readable:
        draw_sentence(layout, DAMAGED, present(context.region).width)
    elif state.stored is not None and (sentence := state.scale_problem(present(context.object))):
        draw_sentence(layout, sentence, present(context.region).width)
    if status.problem and status.problem_of == state.mesh.name_full:
        draw_sentence(layout, status.problem, present(context.region).width)


def _origin_of_parts(state: MeshState) -> str:
    """Return where the parts of a mesh come from, or why there are none."""
    if state.match is not None:
        return translated("Parts of {name}").format(name=state.match.reference)
    if not state.is_readable:
        return translated(ABSENT)
    # The field and its elements.
    words = map(translated, state.summary.description.split(", "))
    return translated("{field}, levels 0 to {highest}").format(field=", ".join(words), highest=state.highest_level)


def _draw_outputs(column: bpy.types.UILayout, settings: MeshSettings) -> None:
    for output in OUTPUTS.values():
        column.prop(settings, output.property_name)
        for option in output.options:
            row = column.row()
            row.active = getattr(settings, output.property_name)
            row.prop(settings, option)
    column.operator("eigenparts.write_eigenfunctions", text="Eigenfunctions")


register, unregister = bpy.utils.register_classes_factory(
    (EIGENPARTS_PT_analyze, EIGENPARTS_PT_options, EIGENPARTS_PT_level, EIGENPARTS_PT_parts, EIGENPARTS_PT_outputs)
)
