"""What the panels of the sidebar tab have in common."""

import bpy

from ..operators import state

# What is said where there is nothing to show yet.
NO_MESH = "Select a mesh object first."


class EigenpartsPanel:
    """A panel of the tab; ``bl_order`` puts them in the order of the work."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenparts"


def active_mesh(context: bpy.types.Context) -> bpy.types.Mesh | None:
    """Return the mesh of the active object, if it is one."""
    return context.object.data if context.object is not None and context.object.type == "MESH" else None


def analyzed_mesh(context: bpy.types.Context) -> bpy.types.Mesh | None:
    """Return the active mesh if it is analyzed."""
    mesh = active_mesh(context)
    return mesh if mesh is not None and state.is_analyzed(mesh) else None


def draw_missing_analysis(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Say why the panel is empty."""
    layout.label(text=NO_MESH if active_mesh(context) is None else state.ABSENT)


def draw_sentence(layout: bpy.types.UILayout, sentence: str, width: int) -> None:
    """Draw a sentence in as many lines as the sidebar needs."""
    # Without a window the interface has no scale.
    n_letters = max(20, int(width / (7 * (bpy.context.preferences.system.ui_scale or 1))))
    column = layout.column(align=True)
    column.alert = True
    line = ""
    for word in bpy.app.translations.pgettext_iface(sentence).split():
        if len(line) + len(word) >= n_letters:
            column.label(text=line, translate=False)
            line = ""
        line = f"{line} {word}".strip()
    column.label(text=line, translate=False)
