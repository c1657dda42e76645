"""What is drawn over the view; the drawing itself needs a window."""

import importlib

import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector

from compute import TriangleMesh, analyze


@pytest.fixture
def overlay(extension):
    return importlib.import_module(f"{extension.__name__}.ui.complex_overlay")


def test_all_objects_of_a_complex_are_drawn_and_no_others(overlay, star_object):
    bpy.ops.eigenparts.trace_complex()
    bpy.context.view_layer.update()
    assert {obj["eigenparts_role"] for obj in overlay.traced_objects(bpy.context)} == set(overlay.COMPLEX_COLOURS)
    bpy.data.collections["Complex of star"].hide_viewport = True
    bpy.context.view_layer.update()
    assert list(overlay.traced_objects(bpy.context)) == []


def test_dots_follow_the_object(overlay, star, star_object):
    bpy.ops.eigenparts.trace_complex()
    star_object.location = (0, 0, 5)
    bpy.context.view_layer.update()
    found = analyze(TriangleMesh(np.float32(star.vertices), star.triangles)).complex_at_level()
    points = found.critical_points
    expected = found.topology.positions[points.vertex[points.kind == 2]] + [0, 0, 5]
    dots = next(obj for obj in overlay.traced_objects(bpy.context) if obj["eigenparts_role"] == "maximum")
    np.testing.assert_allclose(overlay.places_of_dots(dots), expected, atol=1e-5)


def test_dots_are_round_and_face_the_view(overlay):
    view = Matrix.Rotation(0.7, 4, "X") @ Matrix.Rotation(-0.4, 4, "Z")
    centre = Vector((1, 2, 3))
    corners = np.array(overlay.disk_facing_the_view(centre, view, 0.5))
    outer = corners.reshape(-1, 3, 3)[:, 1:].reshape(-1, 3)
    np.testing.assert_allclose(np.linalg.norm(outer - centre, axis=1), 0.5, rtol=1e-6)
    depth = [(view @ Vector(corner)).z for corner in corners]
    np.testing.assert_allclose(depth, depth[0], atol=1e-5)


def test_switching_off_takes_the_handler_away(overlay):
    switch = bpy.context.window_manager
    switch.eigenparts_complex_through = True
    assert overlay._handler is not None
    switch.eigenparts_complex_through = False
    assert overlay._handler is None
