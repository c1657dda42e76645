"""Attributes of all kinds, normals of one's own, and the colours of the view: read, written and given back."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import add_object, corner_normals_of, give_custom_normals
from tests.shapes import icosphere


@pytest.fixture
def ball():
    shape = icosphere(1)
    return add_object(shape.vertices, shape.triangles, "ball").data


@pytest.fixture(scope="module")
def mesh_data(extension):
    from eigenparts.operators.mesh_data import attribute_values, custom_normals

    return attribute_values, custom_normals


VALUES = {
    "FLOAT": [0.25],
    "INT": [-7],
    "INT8": [-128],
    "BOOLEAN": [True],
    "FLOAT2": [0.5, -1.5],
    "FLOAT_VECTOR": [1.0, 2.0, -3.0],
    "FLOAT_COLOR": [0.25, 0.5, 2.0, 1.0],
    # Of 256 steps those at the ends are the same in every colour space.
    "BYTE_COLOR": [0.0, 1.0, 0.0, 1.0],
}


def test_every_kind_that_can_be_read_is_tried(mesh_data):
    assert set(mesh_data[0].STORAGES) == set(VALUES)


@pytest.mark.parametrize("domain", ["POINT", "EDGE", "FACE", "CORNER"])
@pytest.mark.parametrize("kind", VALUES)
def test_values_are_read_as_they_were_written(mesh_data, ball, kind, domain):
    attribute_values, _ = mesh_data
    ball.attributes.new("kept", kind, domain)
    values = np.zeros_like(attribute_values.read_attribute(ball.attributes["kept"]))
    values[::3] = VALUES[kind]
    attribute_values.store_values(ball.attributes["kept"], values)
    np.testing.assert_array_equal(attribute_values.read_attribute(ball.attributes["kept"]), values)


def test_only_what_has_values_between_others_can_be_blended(mesh_data):
    storages = mesh_data[0].STORAGES
    assert {kind for kind in storages if storages[kind].can_blend} == {
        *("FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR")
    }


def pull(mesh):
    """Move some vertices, so that the faces around them turn and take normals that refer to them along."""
    for vertex in mesh.vertices[:12]:
        vertex.co.z *= 1.5
    mesh.update()


def test_normals_of_ones_own_turn_with_the_faces_unless_they_are_kept(mesh_data, ball):
    give_custom_normals(ball)
    before, _ = corner_normals_of(ball)
    pull(ball)
    turned, _ = corner_normals_of(ball)
    assert np.abs(turned - before).max() > 0.1
    with mesh_data[1].normals_kept(ball):
        pull(ball)
    kept, _ = corner_normals_of(ball)
    np.testing.assert_allclose(kept, turned, atol=1e-3)
    assert "eigenparts_kept_normals" not in ball.attributes


def test_a_mesh_without_normals_of_its_own_gets_none(mesh_data, ball):
    names = set(ball.attributes.keys())
    with mesh_data[1].normals_kept(ball):
        pull(ball)
    assert not ball.has_custom_normals
    assert set(ball.attributes.keys()) == names


def shadings():
    screen = bpy.context.window_manager.windows[0].screen
    return [area.spaces.active.shading for area in screen.areas if area.type == "VIEW_3D"]


@pytest.mark.parametrize("before", ["MATERIAL", "RANDOM", "SINGLE", "VERTEX"])
def test_views_show_the_colours_until_they_are_cleared(before, star_object):
    (shading,) = shadings()
    shading.color_type = before
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.segment(level=1)
    assert shading.color_type == "VERTEX"
    bpy.ops.eigenparts.clear()
    assert shading.color_type == before


def test_a_view_that_was_changed_meanwhile_stays_as_it_is(star_object):
    (shading,) = shadings()
    shading.color_type = "MATERIAL"
    bpy.ops.eigenparts.analyze(order="1")
    shading.color_type = "OBJECT"
    bpy.ops.eigenparts.clear()
    assert shading.color_type == "OBJECT"
