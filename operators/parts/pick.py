"""Operator: make a part active by clicking it in the view."""

from dataclasses import dataclass

import bpy
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d
from mathutils import Vector

from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.registered_settings import job_status, mesh_settings
from ..blender.typed_properties import FloatVectorProperty, TypedProperties
from ..mesh_state.state import is_analyzed, read
from ..messages.sentences import in_language
from ..messages.user_errors import refusals_told
from ..outputs.division import PART

HOW = "Click a part; ESC or right click when done."
NOTHING = "There is no surface here."
NO_PARTS = "This object has no parts; analyze it first."
# Where a ray that goes on behind a surface begins, as a fraction of the way to it, and how often it does at most.
BEHIND, MOST_PASSED = 1e-5, 1000


@dataclass(frozen=True)
class Hit:
    """A surface that a ray met: the face of the object as its modifiers leave it, and the place in the world."""

    obj: bpy.types.Object
    face: int
    place: Vector


class EIGENPARTS_OT_pick_part(TypedProperties, bpy.types.Operator):
    """Click parts in the view to make them active in the list, until ESC or right click"""

    bl_idname = "eigenparts.pick_part"
    bl_label = "Pick Part"
    bl_options = {"UNDO"}

    location: tuple[float, float, float] = FloatVectorProperty(
        name="Location", description="Where the ray to the surface begins, in the world", subtype="XYZ"
    )
    direction: tuple[float, float, float] = FloatVectorProperty(
        name="Direction", description="Where the ray goes, in the world", subtype="XYZ", default=(0, 0, -1)
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Parts are picked in object mode.")
        return context.mode == "OBJECT"

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            pick(context, Vector(self.location), Vector(self.direction))
            return {"FINISHED"}
        return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        status = job_status(context)
        # The button is pressed again while it is on: the one that is on leaves at its next event.
        status.is_picking = not status.is_picking
        if not status.is_picking:
            return {"CANCELLED"}
        self._has_picked = False
        show_in_headers(HOW)
        present(context.window).cursor_modal_set("EYEDROPPER")
        present(context.window_manager).modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        is_over = event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"
        if is_over or context.mode != "OBJECT" or not job_status(context).is_picking:
            self.cancel(context)
            return {"FINISHED"} if self._has_picked else {"CANCELLED"}
        view = view_under(present(context.screen), event.mouse_x, event.mouse_y)
        if view is None or event.type != "LEFTMOUSE":
            return {"PASS_THROUGH"}
        if event.value == "PRESS":
            self._pick_under(context, *view, event)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give the view back; Blender too ends the operator, such as when a file is loaded."""
        job_status(context).is_picking = False
        show_in_headers(None)
        present(context.window).cursor_modal_restore()

    def _pick_under(
        self, context: bpy.types.Context, area: bpy.types.Area, region: bpy.types.Region, event: bpy.types.Event
    ) -> None:
        view = area.spaces.active
        assert isinstance(view, bpy.types.SpaceView3D)
        try:
            name = pick(context, *ray_under(region, event), view)
        except Refusal as refusal:
            show_in_headers(f"{refusal} {HOW}")
        else:
            self._has_picked = True
            show_in_headers(f"{name}. {HOW}")


def pick(
    context: bpy.types.Context, origin: Vector, direction: Vector, view: bpy.types.SpaceView3D | None = None
) -> str:
    """Make the part that a ray meets first active in the list, its object the active one, and return its name.

    Parameters
    ----------
    origin, direction : Vector
        In the world.
    view : SpaceView3D, optional
        What cannot be seen in it is passed through.

    Raises
    ------
    Refusal
        If the ray meets nothing, or what it meets has no parts; nothing is changed then.
    """
    hit = first_hit(context, origin, direction, view)
    obj = hit.obj
    part = _part_of_face(context, obj, hit.face)
    settings = mesh_settings(mesh_of(obj))
    parts = [row.part for row in settings.rows]
    if part not in parts:
        raise Refusal(NO_PARTS)
    present(context.view_layer).objects.active = obj
    obj.select_set(True)
    settings.active_row = parts.index(part)
    return read(mesh_of(obj)).parts.name_of(part)


def view_under(screen: bpy.types.Screen, x: int, y: int) -> tuple[bpy.types.Area, bpy.types.Region] | None:
    """Return the 3D view under a place in the window, None where something else is or lies over it."""
    for area in screen.areas:
        under = [
            region
            for region in area.regions
            if region.x <= x < region.x + region.width and region.y <= y < region.y + region.height
        ]
        if area.type == "VIEW_3D" and len(under) == 1 and under[0].type == "WINDOW":
            return area, under[0]
    return None


def ray_under(region: bpy.types.Region, event: bpy.types.Event) -> tuple[Vector, Vector]:
    """Return where the ray from the viewer through the mouse begins, and its direction, in the world."""
    place = event.mouse_x - region.x, event.mouse_y - region.y
    assert isinstance(region.data, bpy.types.RegionView3D)
    origin, direction = (
        action(region, region.data, place) for action in (region_2d_to_origin_3d, region_2d_to_vector_3d)
    )
    return origin, direction


def show_in_headers(text: str | None) -> None:
    """Show a text above all 3D views, or what is there otherwise; views come and go while something is clicked."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                area.header_text_set(text and in_language(text))


def first_hit(context: bpy.types.Context, origin: Vector, direction: Vector, view: bpy.types.SpaceView3D | None) -> Hit:
    """Return the first surface that a ray meets; what cannot be seen in a view is passed through."""
    depsgraph = context.evaluated_depsgraph_get()
    for _ in range(MOST_PASSED):
        found, place, _, face, obj, _ = present(context.scene).ray_cast(depsgraph, origin, direction)
        if not found or obj is None:
            break
        if view is None or obj.visible_in_viewport_get(view):
            return Hit(obj, face, place)
        origin = place + BEHIND * (place - origin)
    raise Refusal(NOTHING)


def _part_of_face(context: bpy.types.Context, obj: bpy.types.Object, face: int) -> int:
    """Return the part of a face of an object as its modifiers leave it: they carry the map of the parts along."""
    if obj.type != "MESH" or not is_analyzed(mesh_of(obj)):
        raise Refusal(NO_PARTS)
    evaluated = obj.evaluated_get(context.evaluated_depsgraph_get())
    try:
        labels = present(evaluated.to_mesh()).attributes.get(PART.name)
        if not isinstance(labels, bpy.types.IntAttribute) or not PART.is_kind_of(labels) or face >= len(labels.data):
            raise Refusal("The modifiers leave no parts on the surface; turn them off in the view to pick one.")
        return labels.data[face].value
    finally:
        evaluated.to_mesh_clear()


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_pick_part,))
