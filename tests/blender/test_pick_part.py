"""Parts are picked by what a ray meets, as under the mouse; the clicks themselves need a window."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector

from tests.blender.conftest import add_object, values_of


def ray_to_face(obj, face, distance=5.0):
    """Return where a ray begins in front of a face and where it goes, in the world."""
    polygon = obj.data.polygons[face]
    centre = obj.matrix_world @ polygon.center
    normal = (obj.matrix_world.to_3x3().inverted().transposed() @ polygon.normal).normalized()
    return {"location": centre + distance * normal, "direction": -normal}


def tip_of(obj, part):
    """Return the face of a part that is farthest out, so that nothing is in front of it."""
    labels = values_of(obj.data, "part")
    centres = np.array([polygon.center for polygon in obj.data.polygons])
    return int(np.argmax(np.where(labels == part, np.linalg.norm(centres, axis=1), -1)))


def pick(obj, part):
    bpy.context.view_layer.update()
    return bpy.ops.eigenparts.pick_part(**ray_to_face(obj, tip_of(obj, part)))


@pytest.mark.parametrize("part", [1, 3, 5])
def test_the_part_under_the_ray_is_active_and_selected(analyzed, part):
    assert pick(analyzed, part) == {"FINISHED"}
    settings = analyzed.data.eigenparts
    assert settings.active_part == settings.rows[settings.active_row].part == part
    selected = [polygon.select for polygon in analyzed.data.polygons]
    np.testing.assert_array_equal(selected, values_of(analyzed.data, "part") == part)


def test_the_ray_goes_through_the_world(analyzed):
    analyzed.matrix_world = Matrix.Translation((3, -2, 1)) @ Matrix.Rotation(1, 4, "X") @ Matrix.Scale(-2, 4, (0, 1, 0))
    pick(analyzed, 4)
    assert analyzed.data.eigenparts.active_part == 4


@pytest.mark.parametrize("modifier", ["SUBSURF", "MIRROR", "DISPLACE"])
def test_modifiers_carry_the_parts_along(analyzed, modifier):
    analyzed.modifiers.new("later", modifier)
    pick(analyzed, 2)
    assert analyzed.data.eigenparts.active_part == 2


def test_modifiers_that_make_a_new_surface_are_told_of(analyzed):
    analyzed.modifiers.new("later", "REMESH").voxel_size = 0.05
    with pytest.raises(RuntimeError, match="leave no parts on the surface"):
        pick(analyzed, 2)
    assert analyzed.data.eigenparts.active_part == -1


def test_another_object_becomes_the_active_one_and_the_selection_stays(analyzed):
    other = bpy.data.objects.new("other", analyzed.data.copy())
    other.location = 10, 0, 0
    bpy.context.collection.objects.link(other)
    pick(other, 3)
    assert bpy.context.object == other
    assert set(bpy.context.selected_objects) == {analyzed, other}
    assert (other.data.eigenparts.active_part, analyzed.data.eigenparts.active_part) == (3, -1)


def test_what_has_no_parts_is_in_the_way(analyzed):
    add_object([(-9, -9, 3), (9, -9, 3), (0, 9, 3)], [(0, 1, 2)], "ceiling")
    with pytest.raises(RuntimeError, match="has no parts"):
        bpy.ops.eigenparts.pick_part(location=(0, 0, 5), direction=(0, 0, -1))
    with pytest.raises(RuntimeError, match="no surface here"):
        bpy.ops.eigenparts.pick_part(location=(0, 0, 5), direction=(0, 0, 1))
    assert analyzed.data.eigenparts.active_part == -1


def test_parts_are_picked_in_object_mode_only(analyzed):
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="in object mode"):
        bpy.ops.eigenparts.pick_part()


def test_a_view_is_found_where_nothing_lies_over_it(extension):
    from types import SimpleNamespace as Thing

    from eigenparts.operators.parts.pick import view_under

    window = Thing(type="WINDOW", x=100, y=50, width=400, height=300)
    sidebar = Thing(type="UI", x=400, y=50, width=100, height=300)
    view = Thing(type="VIEW_3D", regions=[window, sidebar])
    text = Thing(type="TEXT_EDITOR", regions=[Thing(type="WINDOW", x=0, y=0, width=100, height=350)])
    screen = Thing(areas=[text, view])
    assert view_under(screen, 150, 60) == (view, window)
    assert [view_under(screen, *place) for place in ((450, 60), (50, 60), (150, 40), (500, 60))] == [None] * 4


def test_a_ray_passes_through_what_the_view_does_not_show(analyzed, extension):
    from eigenparts.operators.parts.pick import pick

    window = bpy.context.window_manager.windows[0]
    view = next(area for area in window.screen.areas if area.type == "VIEW_3D").spaces.active
    ray = Vector((0, 0, 9)), Vector((0, 0, -1))
    assert pick(bpy.context, *ray, view) == pick(bpy.context, *ray)
    # No collection was chosen to be seen in this view.
    view.use_local_collections = True
    assert not analyzed.visible_in_viewport_get(view)
    with pytest.raises(extension.operators.messages.user_errors.Refusal, match="no surface here"):
        pick(bpy.context, *ray, view)
