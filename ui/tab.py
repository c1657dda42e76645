"""The sidebar tab: the base of its panels, and rows and texts that several of them draw."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ..operators.blender.known_values import mesh_of, present
from ..operators.blender.mixins import PanelMixin
from ..operators.blender.registered_settings import job_status
from ..operators.mesh_data.selected_meshes import other_meshes
from ..operators.mesh_state.schema import ABSENT
from ..operators.mesh_state.state import is_analyzed
from ..operators.messages.sentences import in_language

# What is said where there is nothing to show yet.
NO_MESH = "Select a mesh object first."
# Height of the button that a panel is there for, in rows.
MAIN_BUTTON = 1.3
# Where the progress of a job is drawn, by the operator that runs it; that of all others where analyses start.
PANEL_OF_JOB = {
    "eigenparts.register_selected": "EIGENPARTS_PT_register",
    "eigenparts.next_alternative": "EIGENPARTS_PT_register",
    "eigenparts.flip_function": "EIGENPARTS_PT_register",
    "eigenparts.transfer": "EIGENPARTS_PT_transfer",
    "eigenparts.create_armature": "EIGENPARTS_PT_skeleton",
    "eigenparts.create_skeleton_curves": "EIGENPARTS_PT_skeleton",
}
ANALYZE_PANEL = "EIGENPARTS_PT_analyze"


class EigenpartsPanel(PanelMixin):
    """A panel of the tab; ``bl_order`` puts them in the order of the work."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenparts"


def active_mesh(context: bpy.types.Context) -> bpy.types.Mesh | None:
    """Return the mesh of the active object, if it is one."""
    return mesh_of(context.object) if context.object is not None and context.object.type == "MESH" else None


def analyzed_mesh(context: bpy.types.Context) -> bpy.types.Mesh | None:
    """Return the active mesh if it is analyzed."""
    mesh = active_mesh(context)
    return mesh if mesh is not None and is_analyzed(mesh) else None


def draw_missing_analysis(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Say why the panel is empty."""
    layout.label(text=NO_MESH if active_mesh(context) is None else ABSENT)


def main_row(panel: EigenpartsPanel, context: bpy.types.Context) -> bpy.types.UILayout | None:
    """Return the row of the button a panel is there for; None while its job runs, whose progress is drawn there."""
    row = panel.layout.row(align=True)
    row.scale_y = MAIN_BUTTON
    status = job_status(context)
    if not status.is_running or PANEL_OF_JOB.get(status.job, ANALYZE_PANEL) != panel.bl_idname:
        return row
    row.progress(factor=status.fraction, text=status.text)
    row.operator("eigenparts.cancel", text="", icon="X")
    return None


def draw_direction(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Say from which mesh to how many others something goes."""
    source, others = context.object, other_meshes(context)
    if not others or source is None or source.type != "MESH":
        layout.label(text="Select meshes, the source last", icon="INFO")
        return
    text = translated("{source} to {target}") if len(others) == 1 else translated("{source} to {count} others")
    layout.label(text=text.format(source=source.name, target=others[0].name, count=len(others)), translate=False)


def draw_sentence(layout: bpy.types.UILayout, sentence: str, width: int) -> None:
    """Draw a sentence in as many lines as the sidebar needs, in the colour of what went wrong."""
    column = layout.column(align=True)
    column.alert = True
    draw_hint(column, sentence, width)


def draw_hint(layout: bpy.types.UILayout, sentence: str, width: int) -> None:
    """Draw a sentence in as many lines as the sidebar needs."""
    # Without a window the interface has no scale.
    n_letters = max(20, int(width / (7 * (present(bpy.context.preferences).system.ui_scale or 1))))
    column = layout.column(align=True)
    line = ""
    for word in in_language(sentence, translated).split():
        if len(line) + len(word) >= n_letters:
            column.label(text=line, translate=False)
            line = ""
        line = f"{line} {word}".strip()
    column.label(text=line, translate=False)
