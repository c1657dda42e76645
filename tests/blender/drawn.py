"""Draw the panels of the sidebar without a window: every property that they show is read, every list drawn."""

from types import SimpleNamespace

import bpy

PANELS = (
    *("analyze", "options", "function_hints", "level", "parts", "outputs", "corrections", "register"),
    *("transfer", "transfer_options", "skeleton", "topology"),
)


class Layout:
    """Stands for ``UILayout``: takes any call, and keeps the labels."""

    def __init__(self, labels=None):
        self.labels = [] if labels is None else labels

    def __getattr__(self, name):
        return lambda *arguments, **options: Layout(self.labels)

    def panel(self, name, **options):
        return Layout(self.labels), Layout(self.labels)

    def label(self, text="", **options):
        self.labels.append(text)

    def prop(self, owner, name, **options):
        return getattr(owner, name)

    def template_list(self, listtype_name, list_id, owner, rows_name, active_owner, active_name, **options):
        draw_item = getattr(bpy.types, listtype_name).draw_item
        getattr(active_owner, active_name)
        for index, item in enumerate(getattr(owner, rows_name)):
            draw_item(None, bpy.context, self, owner, item, 0, active_owner, active_name, index, 0)


def draw_panels():
    """Draw all panels for the active object, and return what they say."""
    context = SimpleNamespace(
        scene=bpy.context.scene,
        object=bpy.context.object,
        selected_objects=bpy.context.selected_objects,
        view_layer=bpy.context.view_layer,
        window_manager=bpy.context.window_manager,
        region=SimpleNamespace(width=300),
    )
    layout = Layout()
    for name in PANELS:
        panel = getattr(bpy.types, f"EIGENPARTS_PT_{name}")
        if not hasattr(panel, "poll") or panel.poll(context):
            panel.draw(SimpleNamespace(layout=layout), context)
    if context.object and context.object.type == "MESH" and context.object.data.eigenparts.rows:
        bpy.types.EIGENPARTS_MT_merge.draw(SimpleNamespace(layout=layout), context)
    return layout.labels
