"""Sidebar: correct parts by hand, and the list of what was corrected."""

import bpy

from ..operators.messages.sentences import in_language
from .tab import EigenpartsPanel, analyzed_mesh, draw_missing_analysis


class EIGENPARTS_UL_corrections(bpy.types.UIList):
    """Corrections of the active mesh"""

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flt_flag=0) -> None:
        row = layout.row(align=True)
        name = row.row()
        name.active = not item.rests
        name.label(text=in_language(item.title), translate=False, icon="PAUSE" if item.rests else "CHECKMARK")
        remove = row.operator("eigenparts.remove_correction", text="", icon="X", emboss=False)
        remove.index = item.place


class EIGENPARTS_MT_merge(bpy.types.Menu):
    """Parts that the active part can join"""

    bl_label = "Merge Into"

    def draw(self, context: bpy.types.Context) -> None:
        settings = context.object.data.eigenparts
        active = _active_row(settings)
        for row in settings.rows:
            if active is not None and row.part != active.part:
                merge = self.layout.operator("eigenparts.merge_parts", text=row.title, translate=False)
                merge.part, merge.into = active.part, row.part


class EIGENPARTS_PT_corrections(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Correct by Hand"
    bl_order = 25
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        mesh = analyzed_mesh(context)
        if mesh is None:
            draw_missing_analysis(self.layout, context)
            return
        settings = mesh.eigenparts
        row = _active_row(settings)
        if row is None:
            self.layout.label(text="Click a part in the list", icon="INFO")
        else:
            _draw_part(self.layout, settings, row)
        if len(settings.correction_rows):
            self.layout.template_list(
                *("EIGENPARTS_UL_corrections", "", settings, "correction_rows", settings, "active_correction"), rows=3
            )
            self.layout.operator("eigenparts.clear_corrections", icon="TRASH")


def _active_row(settings: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    return settings.rows[settings.active_row] if 0 <= settings.active_row < len(settings.rows) else None


def _draw_part(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, row: bpy.types.PropertyGroup) -> None:
    """Offer what can be done with a part; the body has no border of its own."""
    layout.label(text=row.title, translate=False)
    along_field = layout.column(align=True)
    along_field.enabled = row.part != 0
    along_field.prop(settings, "part_level")
    along_field.prop(settings, "part_border", slider=True)
    along_field.operator("eigenparts.split_part", icon="MOD_BEVEL").part = row.part
    layout.menu("EIGENPARTS_MT_merge", icon="AUTOMERGE_ON")
    faces = layout.column(align=True)
    faces.operator("eigenparts.paint_part", icon="BRUSH_DATA").part = row.part
    faces.operator("eigenparts.paint_part", text="New Part of Selected Faces", icon="ADD").new = True


register, unregister = bpy.utils.register_classes_factory(
    (EIGENPARTS_UL_corrections, EIGENPARTS_MT_merge, EIGENPARTS_PT_corrections)
)
