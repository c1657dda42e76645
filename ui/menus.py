"""Object menu: all actions in one submenu, which also puts them into the menu search (F3); and those on faces.

Faces are selected in edit mode, so what is done to selected faces is in the Face menu.
"""

import bpy

from ..operators.blender.known_values import present
from .tab import analyzed_mesh

# In the order of the work; None is a line between two groups.
ENTRIES = (
    ("eigenparts.analyze", "MOD_EXPLODE"),
    ("eigenparts.segment", "LOOP_BACK"),
    None,
    ("eigenparts.pick_part", "EYEDROPPER"),
    ("eigenparts.select_part", "RESTRICT_SELECT_OFF"),
    ("eigenparts.merge_parts", "AUTOMERGE_ON"),
    ("eigenparts.split_part", "MOD_BEVEL"),
    ("eigenparts.move_border", "ARROW_LEFTRIGHT"),
    ("eigenparts.set_branch_level", "OUTLINER"),
    None,
    ("eigenparts.register_selected", "LINKED"),
    ("eigenparts.transfer", "MOD_DATA_TRANSFER"),
    None,
    ("eigenparts.create_armature", "ARMATURE_DATA"),
    ("eigenparts.create_skeleton_curves", "CURVE_DATA"),
    None,
    ("eigenparts.cut", "MOD_BOOLEAN"),
    ("eigenparts.separate", "MOD_EXPLODE"),
    ("eigenparts.write_outputs", "OUTPUT"),
    ("eigenparts.write_eigenfunctions", "GRAPH"),
    None,
    ("eigenparts.plot_diagram", "IMAGE_DATA"),
    ("eigenparts.trace_complex", "OUTLINER_OB_CURVE"),
    None,
    ("eigenparts.clear", "TRASH"),
    ("eigenparts.copy_report", "COPYDOWN"),
)


class EIGENPARTS_MT_object(bpy.types.Menu):
    bl_label = "Eigenparts"

    def draw(self, context: bpy.types.Context | None) -> None:
        layout = present(self.layout)
        for entry in ENTRIES:
            if entry is None:
                layout.separator()
            else:
                operator, icon = entry
                # The stubs have no name for the type of icons.
                layout.operator(operator, icon=icon)  # type: ignore[arg-type]


def _draw_entry(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    layout = present(menu.layout)
    layout.separator()
    layout.menu("EIGENPARTS_MT_object")


def _draw_on_faces(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    if analyzed_mesh(context) is not None:
        layout = present(menu.layout)
        layout.separator()
        layout.operator("eigenparts.paint_part", icon="BRUSH_DATA")
        new = layout.operator("eigenparts.paint_part", text="New Part of Selected Faces", icon="ADD")
        present(new).new = True


# Blender's menus, and what is drawn at their ends.
EXTENDED = ((bpy.types.VIEW3D_MT_object, _draw_entry), (bpy.types.VIEW3D_MT_edit_mesh_faces, _draw_on_faces))

_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EIGENPARTS_MT_object,))


def register() -> None:
    """Add the submenu to the Object menu, and what is done to faces to the Face menu."""
    _register_classes()
    for menu, draw in EXTENDED:
        # The stubs leave out that Blender hands over the menu before the context.
        menu.append(draw)  # type: ignore[arg-type]


def unregister() -> None:
    """Take them away."""
    for menu, draw in reversed(EXTENDED):
        menu.remove(draw)  # type: ignore[arg-type]
    _unregister_classes()
