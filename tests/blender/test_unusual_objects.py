"""Objects that are not plain: linked, shared, hidden, scaled to nothing, with shape keys, in other modes or scenes."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, values_of
from tests.blender.drawn import draw_panels
from tests.blender.failing import all_of
from tests.blender.pressed import press

QUICK = {
    "segment": {"level": 1},
    "write_outputs": {"outputs": {"FACE_SETS", "VERTEX_GROUPS"}},
    "split_part": {"part": 1, "position": 0.3},
    "move_border": {"part": 2, "offset": 0.05},
    "merge_parts": {"part": 2, "into": 0},
    "clear_corrections": {},
    "cut": {},
    "separate": {},
    "clear": {},
}
ALL = {
    **{"analyze": {"order": "1"}, "select_part": {"part": 1}, "create_armature": {"order": "1"}},
    **{"create_skeleton_curves": {"order": "1"}, "write_eigenfunctions": {}, "trace_complex": {"order": "1"}},
    **{"paint_part": {"part": 1}, **QUICK},
}


pytestmark = pytest.mark.usefixtures("tracebacks")


def outcome_of(operator):
    """Call an operator and return what it said if it refused."""
    return press(operator, **ALL[operator]).sentence


def link(path, overrides_mesh=False):
    """Open an empty file and link the object of another into it; return it, active."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(path), link=True) as (_, target):
        target.objects = ["star"]
    obj = target.objects[0]
    bpy.context.collection.objects.link(obj)
    if overrides_mesh:
        obj = obj.override_create(remap_local_usages=True)
        obj.data = obj.data.override_create(remap_local_usages=True)
    bpy.context.view_layer.objects.active = obj
    return obj


@pytest.fixture
def library(analyzed, tmp_path):
    path = tmp_path / "library.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path


@pytest.mark.parametrize("overrides_mesh", [False, True])
def test_a_linked_mesh_is_never_written_to(library, overrides_mesh):
    obj = link(library, overrides_mesh)
    before = all_of(obj.data)
    for operator in ALL:
        assert "make it local" in outcome_of(operator), operator
    draw_panels()
    assert all_of(obj.data) == before


def test_the_slider_of_an_overridden_mesh_says_why_it_does_not_move(library):
    obj = link(library, overrides_mesh=True)
    before = all_of(obj.data)
    obj.data.eigenparts.level = 1
    assert all_of(obj.data) == before
    assert "make it local" in bpy.context.window_manager.eigenparts.problem


@pytest.mark.parametrize("operator", ["transfer", "register_selected"])
def test_a_linked_mesh_is_no_target_either(library, star, operator):
    obj = link(library)
    source = add_object(star.vertices, star.triangles, "source")
    source.vertex_groups.new(name="group").add([0, 1], 1.0, "REPLACE")
    obj.select_set(True)
    before = all_of(obj.data)
    with pytest.raises(RuntimeError, match="make it local"):
        getattr(bpy.ops.eigenparts, operator)()
    assert all_of(obj.data) == before


def test_a_linked_mesh_that_was_made_local_goes_on(library):
    obj = link(library)
    obj.make_local()
    obj.data.make_local()
    assert bpy.ops.eigenparts.segment(level=1) == {"FINISHED"}


def test_objects_that_share_a_mesh_share_its_parts(analyzed):
    twin = bpy.data.objects.new("twin", analyzed.data)
    bpy.context.collection.objects.link(twin)
    bpy.context.view_layer.objects.active = twin
    assert bpy.ops.eigenparts.segment(level=2) == {"FINISHED"}
    assert "used 2 times" in outcome_of("cut")
    n_faces = len(analyzed.data.polygons)
    bpy.ops.eigenparts.separate()
    assert len(analyzed.data.polygons) == n_faces
    assert len(twin.data.polygons) < n_faces


def test_an_instance_of_a_collection_is_no_mesh(analyzed):
    collection = bpy.data.collections.new("stars")
    collection.objects.link(analyzed)
    instance = bpy.data.objects.new("instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", collection
    bpy.context.collection.objects.link(instance)
    bpy.context.view_layer.objects.active = instance
    assert all("Select a mesh object" in outcome_of(operator) for operator in ALL)


def hide_by_the_eye(obj):
    obj.hide_set(True)


def hide_in_viewports(obj):
    obj.hide_viewport = True


def hide_the_collection(obj):
    """In viewports, with another one to which new objects could go."""
    collection = bpy.data.collections.new("hidden")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    bpy.context.view_layer.objects.active = obj
    collection.hide_viewport = True


def scale_to_nothing(obj):
    obj.scale = 0, 0, 0


def flatten(obj):
    obj.scale.z = 0


def mirror(obj):
    obj.scale = -1, 2, -3


def put_under_a_flat_parent(obj):
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale = 0, 1, -1
    obj.parent = parent


def give_shape_keys(obj):
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Bent")
    key.data[3].co.x += 1
    key.value = 0.5


def lock(obj):
    obj.hide_select = True


def use_fake_user(obj):
    obj.data.use_fake_user = True


UNUSUAL = [
    *(hide_by_the_eye, hide_in_viewports, hide_the_collection),
    *(give_shape_keys, lock, use_fake_user),
]
RESCALED = [scale_to_nothing, flatten, mirror, put_under_a_flat_parent]


@pytest.mark.parametrize("operator", ALL)
@pytest.mark.parametrize("make_unusual", UNUSUAL)
def test_every_operator_works_on_unusual_objects_or_says_why_not(analyzed, make_unusual, operator):
    make_unusual(analyzed)
    refused = outcome_of(operator)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    draw_panels()
    assert not analyzed.data.validate()
    assert not refused or operator in ("select_part", "create_armature", "paint_part"), refused


@pytest.mark.parametrize("operator", ALL)
@pytest.mark.parametrize("rescale", RESCALED)
def test_every_operator_works_on_objects_that_were_scaled_or_names_the_scale(analyzed, rescale, operator):
    before = all_of(analyzed.data)
    rescale(analyzed)
    refused = outcome_of(operator)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    draw_panels()
    if refused and operator not in ("select_part", "paint_part"):
        assert "scale" in refused
        assert all_of(analyzed.data) == before
    assert not (refused and rescale is mirror and operator in ("analyze", "write_eigenfunctions"))


@pytest.mark.parametrize("operator", ALL)
@pytest.mark.parametrize("mode", ["EDIT", "SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT", "TEXTURE_PAINT"])
def test_every_operator_works_in_other_modes_or_says_why_not(analyzed, mode, operator):
    before = all_of(analyzed.data)
    bpy.ops.object.mode_set(mode=mode)
    refused = outcome_of(operator)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    if refused:
        assert all_of(bpy.data.objects["star"].data)[1:] == before[1:]
    draw_panels()


@pytest.mark.parametrize("operator", sorted(set(ALL) - {"paint_part"}))
def test_nothing_is_done_where_another_object_has_the_mesh_in_edit_mode(analyzed, operator):
    other = analyzed.copy()
    bpy.context.collection.objects.link(other)
    bpy.context.view_layer.objects.active = other
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.context.view_layer.objects.active = analyzed
    assert "Leave edit mode first" in outcome_of(operator)
    draw_panels()


def test_an_object_outside_the_view_layer_is_left_alone(analyzed, star):
    other = add_object(star.vertices, star.triangles, "other")
    bpy.context.collection.objects.unlink(analyzed)
    bpy.context.view_layer.objects.active = other
    draw_panels()
    bpy.ops.eigenparts.analyze(order="1")
    bpy.context.view_layer.objects.active = None
    assert "Select a mesh object" in outcome_of("analyze")


def test_a_mesh_in_another_scene_shows_what_was_made_in_this_one(analyzed):
    other = bpy.data.scenes.new("other")
    other.collection.objects.link(analyzed)
    bpy.context.window.scene = other
    other.view_layers[0].objects.active = analyzed
    bpy.ops.eigenparts.segment(level=1)
    labels = values_of(analyzed.data, "part")
    bpy.context.window.scene = bpy.data.scenes[0]
    np.testing.assert_array_equal(values_of(analyzed.data, "part"), labels)
