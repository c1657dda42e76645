"""Sidebar: register meshes, and what was matched with what."""

import bpy

from ..operators import registered

FUNCTIONS_IN_A_ROW = 4


class EIGENPARTS_PT_register(bpy.types.Panel):
    bl_label = "Register"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Eigenparts"
    bl_order = 30
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        row = self.layout.row(align=True)
        row.operator("eigenparts.register_selected", icon="LINKED").mirrored = False
        row.operator("eigenparts.register_selected", text="", icon="MOD_MIRROR").mirrored = True
        for obj, match in registered.registered_objects(context):
            _draw_match(self.layout.box(), obj.name, match)


def _draw_match(layout: bpy.types.UILayout, name: str, match: registered.Match) -> None:
    row = layout.row()
    row.label(text=name, icon="CHECKMARK" if match.confidence > registered.SURE else "QUESTION")
    share = row.row()
    share.alignment = "RIGHT"
    share.label(text=f"{match.confidence:.0%}")
    if match.n_alternatives:
        text = f"{match.alternative + 1} of {match.n_alternatives + 1}"
        row.operator("eigenparts.next_alternative", text=text, icon="FILE_REFRESH").object_name = name
    if match.same_topology:
        layout.label(text=f"Same faces as {match.reference}")
    else:
        layout.label(text=f"Functions of {match.reference}")
    grid = layout.grid_flow(row_major=True, columns=FUNCTIONS_IN_A_ROW, even_columns=True, align=True)
    for number, (place, sign) in enumerate(zip(match.order, match.signs, strict=True), start=1):
        flip = grid.operator("eigenparts.flip_function", text=f"{number}: {'-' if sign < 0 else '+'}{place}")
        flip.object_name, flip.number = name, number
    if match.by_diagrams:
        layout.label(text=_told_by_diagrams(match.by_diagrams))


def _told_by_diagrams(by_diagrams: tuple[int, ...]) -> str:
    """Return what persistence diagrams alone say, which does not decide; a question mark where the sign stays open."""
    return "By diagrams: " + " ".join(f"{number:+d}" if number else "?" for number in by_diagrams)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_register,))
