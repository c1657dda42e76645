"""The list of parts: colour, name, area and how they are nested."""

from typing import Any

import bpy

from ..operators.blender.known_values import present
from ..operators.blender.registered_settings import PartRow


class EIGENPARTS_UL_parts(bpy.types.UIList):
    """Parts of the active mesh"""

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
        part: PartRow = item
        row = layout.row(align=True)
        if part.depth:
            row.separator(factor=2.0 * part.depth)
        swatch = row.row()
        swatch.ui_units_x = 0.9
        swatch.prop(part, "color", text="")
        row.prop(part, "title", text="", emboss=False)
        share = row.row()
        share.alignment = "RIGHT"
        share.label(text=f"{part.share:.1%}")
        select = row.operator("eigenparts.select_part", text="", icon="RESTRICT_SELECT_OFF", emboss=False)
        present(select).part = part.part


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_UL_parts,))
