"""Operator: give a pair of points by two clicks, one on each of two meshes."""

import bpy
import numpy as np
from mathutils import Vector

from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.registered_settings import point_pairs
from ..blender.typed_properties import IntProperty, StringProperty, TypedProperties
from ..mesh_data.viewport import redraw_views
from ..mesh_state.point_pairs import PointEnd, numbered_pairs, shown_places
from ..messages.user_errors import refusals_told
from ..parts.pick import NOTHING, first_hit, ray_under, show_in_headers, view_under

FIRST = "Click a point of one mesh; ESC or right click to stop."
SECOND = "Click the point of another mesh that it belongs to; ESC or right click to stop."
ONE_MESH = "Both points are on the same mesh; a pair is of two meshes."


class EIGENPARTS_OT_add_point_pair(TypedProperties, bpy.types.Operator):
    """Click a point of one mesh, then the point of another that it belongs to; Register and Transfer keep to it"""

    bl_idname = "eigenparts.add_point_pair"
    bl_label = "Add Points"
    bl_options = {"UNDO"}

    source: str = StringProperty(name="Object", description="Name of one object; the active one if empty")
    source_vertex: int = IntProperty(name="Vertex", description="Number of its vertex", min=0)
    target: str = StringProperty(name="Other Object", description="Name of the other object")
    target_vertex: int = IntProperty(name="Other Vertex", description="Number of its vertex", min=0)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Points are given in object mode.")
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            name = self.source or (context.object.name if context.object is not None else "")
            add_pair(context, point_end(context, name, self.source_vertex),
                     point_end(context, self.target, self.target_vertex))  # fmt: skip
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        # By its name: between two clicks an undo may free the object.
        self._first: tuple[str, int] | None = None
        show_in_headers(FIRST)
        present(context.window).cursor_modal_set("EYEDROPPER")
        present(context.window_manager).modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        is_over = event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"
        if is_over or context.mode != "OBJECT":
            self.cancel(context)
            return {"CANCELLED"}
        view = view_under(present(context.screen), event.mouse_x, event.mouse_y)
        if view is None or event.type != "LEFTMOUSE":
            return {"PASS_THROUGH"}
        if event.value == "PRESS" and self._has_pair(context, *view, event):
            self.cancel(context)
            return {"FINISHED"}
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give the view back; Blender too ends the operator, such as when a file is loaded."""
        show_in_headers(None)
        present(context.window).cursor_modal_restore()

    def _has_pair(
        self, context: bpy.types.Context, area: bpy.types.Area, region: bpy.types.Region, event: bpy.types.Event
    ) -> bool:
        """Take the point under the mouse, and return whether it made a pair."""
        view = area.spaces.active
        assert isinstance(view, bpy.types.SpaceView3D)
        try:
            end = point_under(context, *ray_under(region, event), view)
            if self._first is not None:
                add_pair(context, point_end(context, *self._first), end)
                return True
            self._first = end.obj.name, end.vertex
            show_in_headers(SECOND)
        except Refusal as refusal:
            show_in_headers(f"{refusal} {FIRST if self._first is None else SECOND}")
        return False


def add_pair(context: bpy.types.Context, first: PointEnd, second: PointEnd) -> None:
    """Add a pair of points to the list of the scene.

    Raises
    ------
    Refusal
        If both are on one mesh, or one of them belongs to another point of the same two objects.
    """
    if mesh_of(first.obj) == mesh_of(second.obj):
        raise Refusal(ONE_MESH)
    new = {end.obj: end.vertex for end in (first, second)}
    for number, ends in numbered_pairs(context):
        given = {end.obj: end.vertex for end in ends}
        if given.keys() == new.keys() and any(given[obj] == new[obj] for obj in new):
            raise Refusal(f"Point {number} is at one of these vertices; remove it first.")
    row = point_pairs(context).add()
    row.source, row.source_vertex, row.n_source = first.obj, first.vertex, first.n_vertices
    row.target, row.target_vertex, row.n_target = second.obj, second.vertex, second.n_vertices
    redraw_views(context)


def point_end(context: bpy.types.Context, name: str, vertex: int) -> PointEnd:
    """Return a vertex of the object of a name, or say why there is none."""
    obj = present(context.view_layer).objects.get(name)
    if obj is None or obj.type != "MESH":
        raise Refusal(f'There is no mesh object "{name}" here.')
    n_vertices = len(mesh_of(obj).vertices)
    if not 0 <= vertex < n_vertices:
        raise Refusal(f"{name} has no vertex {vertex}; it has {n_vertices}.")
    return PointEnd(obj, vertex, n_vertices)


def point_under(
    context: bpy.types.Context, origin: Vector, direction: Vector, view: bpy.types.SpaceView3D | None = None
) -> PointEnd:
    """Return the vertex that is nearest to where a ray meets the first surface.

    Raises
    ------
    Refusal
        If the ray meets no mesh.
    """
    hit = first_hit(context, origin, direction, view)
    if hit.obj.type != "MESH" or not len(mesh_of(hit.obj).vertices):
        raise Refusal(NOTHING)
    places = shown_places(hit.obj, context.evaluated_depsgraph_get())
    away = places - np.array(hit.obj.matrix_world.inverted_safe() @ hit.place)
    return PointEnd(hit.obj, int((away**2).sum(axis=1).argmin()), len(places))


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_add_point_pair,))
