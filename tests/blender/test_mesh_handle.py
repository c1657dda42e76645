"""A job finds its mesh and object again, or says why it cannot."""

import bpy
import pytest

from tests.blender.conftest import add_object


@pytest.fixture
def handle(star_object):
    from eigenparts.operators.jobs.mesh_handle import MeshHandle

    return MeshHandle.of(star_object)


@pytest.fixture
def refused(extension):
    from eigenparts.tasks.refusals import Refusal

    return lambda sentence: pytest.raises(Refusal, match=sentence)


def test_object_and_mesh_are_found_under_other_names(handle, star_object):
    star_object.name, star_object.data.name = "renamed", "too"
    bpy.data.objects.new("star", None)
    assert handle.find_mesh() == star_object.data
    assert handle.find_object() == star_object


def test_a_mesh_that_was_edited_is_refused(handle, star_object, refused):
    star_object.data.vertices[0].co.z += 1
    with refused("edited while it was analyzed"):
        handle.find_mesh()
    star_object.data.vertices[0].co.z -= 1
    assert handle.find_mesh() == star_object.data


def test_a_mesh_in_edit_mode_is_refused(handle, refused):
    bpy.ops.object.mode_set(mode="EDIT")
    with refused("leave edit mode"):
        handle.find_object()


def test_an_object_that_was_deleted_is_refused(handle, star_object, refused):
    keeper = bpy.data.objects.new("keeper", star_object.data)
    bpy.data.objects.remove(star_object)
    assert handle.find_mesh() == keeper.data
    with refused("An object was deleted"):
        handle.find_object()
    with refused("not this one"):
        handle.find_object("not this one")


def test_the_view_has_the_active_object_or_another_one_with_the_mesh(handle, star_object, star, refused):
    twin = bpy.data.objects.new("twin", star_object.data)
    bpy.context.collection.objects.link(twin)
    bpy.context.view_layer.objects.active = twin
    assert handle.find_object_in_view(bpy.context) == twin
    bpy.context.view_layer.objects.active = add_object(star.vertices, star.triangles, "other")
    assert handle.find_object_in_view(bpy.context) in (star_object, twin)
    for obj in (star_object, twin):
        bpy.context.collection.objects.unlink(obj)
    bpy.context.view_layer.update()
    with refused("not in the view layer"):
        handle.find_object_in_view(bpy.context)


def test_a_complex_finds_an_object_that_was_renamed_while_it_was_computed(star_object, monkeypatch):
    from eigenparts.operators.parts import fresh_analysis

    analyze = fresh_analysis.analyze_topology

    def rename_meanwhile(given, progress):
        star_object.name = "renamed"
        return analyze(given, progress)

    monkeypatch.setattr(fresh_analysis, "analyze_topology", rename_meanwhile)
    assert bpy.ops.eigenparts.trace_complex(order="1") == {"FINISHED"}
    assert "Complex of renamed" in bpy.data.collections
