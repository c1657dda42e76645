"""Object menu: all actions in one submenu, which also puts them into the menu search (F3); and those on faces.

Faces are selected in edit mode, so what is done to selected faces is in the Face menu.
"""

import bpy

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

    def draw(self, context: bpy.types.Context) -> None:
        for entry in ENTRIES:
            if entry is None:
                self.layout.separator()
            else:
                self.layout.operator(entry[0], icon=entry[1])


def _draw_entry(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    menu.layout.separator()
    menu.layout.menu("EIGENPARTS_MT_object")


def _draw_on_faces(menu: bpy.types.Menu, context: bpy.types.Context) -> None:
    if analyzed_mesh(context) is not None:
        menu.layout.separator()
        menu.layout.operator("eigenparts.paint_part", icon="BRUSH_DATA")
        menu.layout.operator("eigenparts.paint_part", text="New Part of Selected Faces", icon="ADD").new = True


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((EIGENPARTS_MT_object,))


def register() -> None:
    """Add the submenu to the Object menu, and what is done to faces to the Face menu."""
    _register_classes()
    bpy.types.VIEW3D_MT_object.append(_draw_entry)
    bpy.types.VIEW3D_MT_edit_mesh_faces.append(_draw_on_faces)


def unregister() -> None:
    """Take them away."""
    bpy.types.VIEW3D_MT_edit_mesh_faces.remove(_draw_on_faces)
    bpy.types.VIEW3D_MT_object.remove(_draw_entry)
    _unregister_classes()
