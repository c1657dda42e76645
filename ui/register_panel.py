"""Sidebar: register meshes, and what was matched with what."""

import bpy
from bpy.app.translations import pgettext_iface as translated

from ..operators.blender.known_values import present
from ..operators.blender.registered_settings import point_pairs
from ..operators.mesh_state.point_pairs import PointEnd, ends_of
from ..operators.mesh_state.references import registered_objects
from ..operators.mesh_state.registration_record import SURE, Match
from .tab import EigenpartsPanel, draw_direction, main_row

FUNCTIONS_IN_A_ROW = 4


class EIGENPARTS_PT_register(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Register"
    bl_order = 30
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        draw_direction(layout, context)
        row = main_row(self, context)
        if row is not None:
            present(row.operator("eigenparts.register_selected", icon="LINKED")).mirrored = False
            present(row.operator("eigenparts.register_selected", text="", icon="MOD_MIRROR")).mirrored = True
        for obj, state in registered_objects(context):
            match = present(state.match)
            header, body = layout.panel(f"eigenparts_match_{obj.session_uid}", default_closed=True)
            _draw_confidence(header, obj.name, match)
            if body is not None:
                _draw_match(body, obj.name, match)


def _draw_confidence(layout: bpy.types.UILayout, name: str, match: Match) -> None:
    layout.label(
        text=f"{name}  {match.confidence:.0%}",
        icon="CHECKMARK" if match.confidence > SURE else "QUESTION",
        translate=False,
    )
    if match.n_alternatives:
        text = translated("{number} of {all}").format(number=match.alternative + 1, all=match.n_alternatives + 1)
        following = layout.row()
        following.alignment = "RIGHT"
        button = following.operator("eigenparts.next_alternative", text=text, icon="FILE_REFRESH", translate=False)
        present(button).object_name = name


def _draw_match(layout: bpy.types.UILayout, name: str, match: Match) -> None:
    told = translated("Same faces as {name}") if match.same_topology else translated("Functions of {name}")
    layout.label(text=told.format(name=match.reference), translate=False)
    grid = layout.grid_flow(row_major=True, columns=FUNCTIONS_IN_A_ROW, even_columns=True, align=True)
    for number, (place, sign) in enumerate(zip(match.order, match.signs, strict=True), start=1):
        text = f"{number}: {'-' if sign < 0 else '+'}{place}"
        flip = present(grid.operator("eigenparts.flip_function", text=text, translate=False))
        flip.object_name, flip.number = name, number
    if match.by_diagrams:
        layout.label(text=_told_by_diagrams(match.by_diagrams), translate=False)


def _told_by_diagrams(by_diagrams: tuple[int, ...]) -> str:
    """Return what persistence diagrams alone say, which does not decide; a question mark where the sign stays open."""
    signs = " ".join(f"{number:+d}" if number else "?" for number in by_diagrams)
    return translated("By diagrams: {signs}").format(signs=signs)


class EIGENPARTS_PT_points(EigenpartsPanel, bpy.types.Panel):
    bl_label = "Points"
    bl_parent_id = "EIGENPARTS_PT_register"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        rows = point_pairs(context)
        column = self.layout.column(align=True)
        for number, row in enumerate(rows, start=1):
            line = column.row(align=True)
            ends = ends_of(row)
            line.alert = not ends or not all(end.is_there for end in ends)
            line.label(text=f"{number}  {_told_of_ends(ends)}", translate=False)
            present(line.operator("eigenparts.remove_point_pair", text="", icon="X")).number = number
        buttons = self.layout.row(align=True)
        # The fields of the call are for scripts; the button lets the user click.
        buttons.operator("eigenparts.add_point_pair", icon="ADD")
        if len(rows):
            buttons.operator("eigenparts.clear_point_pairs", text="", icon="TRASH")


def _told_of_ends(ends: tuple[PointEnd, ...]) -> str:
    if not ends:
        return translated("An object is gone")
    return " – ".join(f"{end.obj.name} {end.vertex}" for end in ends)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_PT_register, EIGENPARTS_PT_points))
