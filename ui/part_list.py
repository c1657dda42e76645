"""The list of parts: colour, name, area and how they are nested."""

import bpy


class EIGENPARTS_UL_parts(bpy.types.UIList):
    """Parts of the active mesh"""

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flt_flag=0) -> None:
        row = layout.row(align=True)
        if item.depth:
            row.separator(factor=2.0 * item.depth)
        swatch = row.row()
        swatch.ui_units_x = 0.9
        swatch.prop(item, "color", text="")
        row.prop(item, "title", text="", emboss=False)
        share = row.row()
        share.alignment = "RIGHT"
        share.label(text=f"{item.share:.1%}")
        select = row.operator("eigenparts.select_part", text="", icon="RESTRICT_SELECT_OFF", emboss=False)
        select.part = item.part


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_UL_parts,))
