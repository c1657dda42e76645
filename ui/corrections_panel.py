"""Sidebar: correct parts by hand, and the list of what was corrected."""

from typing import Any

import bpy

from ..operators.blender.known_values import mesh_of, present
from ..operators.blender.registered_settings import CorrectionRow, MeshSettings, PartRow, mesh_settings
from ..operators.messages.sentences import in_language
from .tab import EigenpartsPanel, analyzed_mesh, draw_missing_analysis


class EIGENPARTS_UL_corrections(bpy.types.UIList):
    """Corrections of the active mesh"""

    def draw_item(
        self,
        context: bpy.types.Context | None,
        layout: bpy.types.UILayout,
        data: object,
        item: Any,
        icon: int | None,
        active_data: object,
        active_property: str | None,
        index: int | None = 0,
        flt_flag: int | None = 0,
    ) -> None:
        correction: CorrectionRow = item
        row = layout.row(align=True)
        name = row.row()
        name.active = not correction.rests
        name.label(
            text=in_language(correction.title), translate=False, icon="PAUSE" if correction.rests else "CHECKMARK"
        )
        remove = row.operator("eigenparts.remove_correction", text="", icon="X", emboss=False)
        present(remove).index = correction.place


class EIGENPARTS_MT_merge(bpy.types.Menu):
    """Parts that the active part can join"""

    bl_label = "Merge Into"

    def draw(self, context: bpy.types.Context | None) -> None:
        layout, settings = present(self.layout), mesh_settings(mesh_of(present(context).object))
        active = _active_row(settings)
        for row in settings.rows:
            if active is not None and row.part != active.part:
                merge = present(layout.operator("eigenparts.merge_parts", text=row.title, translate=False))
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
        settings = mesh_settings(mesh)
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


def _active_row(settings: MeshSettings) -> PartRow | None:
    return settings.rows[settings.active_row] if 0 <= settings.active_row < len(settings.rows) else None


def _draw_part(layout: bpy.types.UILayout, settings: MeshSettings, row: PartRow) -> None:
    """Offer what can be done with a part; the body has no border of its own."""
    layout.label(text=row.title, translate=False)
    layout.prop(settings, "mirror")
    along_field = layout.column(align=True)
    along_field.enabled = row.part != 0
    along_field.prop(settings, "part_level")
    along_field.prop(settings, "part_border", slider=True)
    present(along_field.operator("eigenparts.split_part", icon="MOD_BEVEL")).part = row.part
    layout.menu("EIGENPARTS_MT_merge", icon="AUTOMERGE_ON")
    faces = layout.column(align=True)
    present(faces.operator("eigenparts.paint_part", icon="BRUSH_DATA")).part = row.part
    present(faces.operator("eigenparts.paint_part", text="New Part of Selected Faces", icon="ADD")).new = True


register, unregister = bpy.utils.register_classes_factory(
    (EIGENPARTS_UL_corrections, EIGENPARTS_MT_merge, EIGENPARTS_PT_corrections)
)
