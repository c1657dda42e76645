"""Nothing of the user's is overwritten, and Clear takes back all that is ours."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import everything_on


def add_attribute(mesh, name, data_type="INT", domain="FACE"):
    return mesh.attributes.new(name, data_type, domain)


@pytest.mark.parametrize("name", ["part", "part_vertex", "part_color", "eigenparts_branch"])
def test_an_attribute_of_the_user_is_never_overwritten(star_object, name):
    add_attribute(star_object.data, name, "FLOAT", "POINT").data.foreach_set(
        "value", np.full(len(star_object.data.vertices), 5.0)
    )
    before = everything_on(star_object.data)
    with pytest.raises(RuntimeError, match=f'attribute "{name}" that is not from Eigenparts'):
        bpy.ops.eigenparts.analyze()
    assert everything_on(star_object.data) == before


def test_an_attribute_the_user_put_in_place_of_ours_is_not_overwritten(analyzed):
    mesh = analyzed.data
    mesh.attributes.remove(mesh.attributes["part"])
    add_attribute(mesh, "part", "FLOAT", "POINT")
    with pytest.raises(RuntimeError, match="not from Eigenparts"):
        bpy.ops.eigenparts.segment(level=1)


def test_clear_leaves_the_mesh_as_it_was(star_object):
    mesh = star_object.data
    add_attribute(mesh, "mine")
    mesh.color_attributes.new("my colours", "FLOAT_COLOR", "CORNER")
    mesh.color_attributes.active_color_name = "my colours"
    mesh["my property"] = 3
    before = everything_on(mesh)
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.segment(level=1)
    assert everything_on(mesh) != before
    bpy.ops.eigenparts.clear()
    assert everything_on(mesh) == before


def shadings():
    return [
        area.spaces.active.shading
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        if area.type == "VIEW_3D"
    ]


def test_views_show_the_colours_until_the_last_mesh_is_cleared(star_object):
    assert shadings()
    for shading in shadings():
        shading.color_type = "OBJECT"
    bpy.ops.eigenparts.analyze()
    assert {shading.color_type for shading in shadings()} == {"VERTEX"}
    bpy.ops.eigenparts.segment(level=1)
    bpy.ops.eigenparts.clear()
    assert {shading.color_type for shading in shadings()} == {"OBJECT"}


def test_a_view_that_showed_vertex_colours_already_keeps_them(star_object):
    for shading in shadings():
        shading.color_type = "VERTEX"
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.clear()
    assert {shading.color_type for shading in shadings()} == {"VERTEX"}
