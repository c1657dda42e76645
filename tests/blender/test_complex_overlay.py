"""What is drawn over the view; the drawing itself needs a window."""

import importlib

import bmesh
import bpy
import numpy as np
import pytest
from mathutils import Matrix, Vector

from compute import TriangleMesh, analyze


@pytest.fixture
def overlay(extension):
    return importlib.import_module(f"{extension.__name__}.ui.complex_overlay")


@pytest.fixture
def switches(extension):
    return importlib.import_module(f"{extension.__name__}.ui.overlay_switches")


@pytest.fixture
def drawing(extension):
    return importlib.import_module(f"{extension.__name__}.ui.overlay_drawing")


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
    np.testing.assert_allclose(overlay.critical_points_of(dots), expected, atol=1e-5)


def test_dots_are_round_and_face_the_view(drawing):
    view = Matrix.Rotation(0.7, 4, "X") @ Matrix.Rotation(-0.4, 4, "Z")
    centre = Vector((1, 2, 3))
    corners = np.array(drawing.disk_facing_the_view(centre, view, 0.5))
    outer = corners.reshape(-1, 3, 3)[:, 1:].reshape(-1, 3)
    np.testing.assert_allclose(np.linalg.norm(outer - centre, axis=1), 0.5, rtol=1e-6)
    depth = [(view @ Vector(corner)).z for corner in corners]
    np.testing.assert_allclose(depth, depth[0], atol=1e-5)


@pytest.mark.parametrize("switch", ["critical_points", "separatrices", "level_sets"])
def test_a_switch_hides_what_it_names_and_nothing_else(overlay, switches, star_object, switch):
    bpy.ops.eigenparts.trace_complex()
    bpy.context.view_layer.update()
    assert getattr(bpy.context.window_manager, f"eigenparts_{switch}")
    setattr(bpy.context.window_manager, f"eigenparts_{switch}", False)
    shown = {obj["eigenparts_role"] for obj in overlay.traced_objects(bpy.context)}
    assert shown == set(overlay.COMPLEX_COLOURS) - set(switches.SHOWN[switch][2])
    setattr(bpy.context.window_manager, f"eigenparts_{switch}", True)
    assert {obj["eigenparts_role"] for obj in overlay.traced_objects(bpy.context)} == set(overlay.COMPLEX_COLOURS)


def test_switches_are_off_where_nothing_is_traced(switches, star_object):
    assert not any(getattr(bpy.context.window_manager, f"eigenparts_{switch}") for switch in switches.SHOWN)


def lines_of(obj):
    from eigenparts.operators.parts.border_lines import border_lines

    return border_lines(obj, bpy.context.evaluated_depsgraph_get())


def test_borders_are_the_edges_between_faces_of_two_parts(analyzed):
    edited = bmesh.new()
    edited.from_mesh(analyzed.data)
    part = edited.faces.layers.int["part"]
    between = [edge for edge in edited.edges if len({face[part] for face in edge.link_faces}) > 1]
    expected = {tuple(sorted(tuple(vertex.co) for vertex in edge.verts)) for edge in between}
    ends = lines_of(analyzed).reshape(-1, 2, 3).tolist()
    assert {tuple(sorted(map(tuple, line))) for line in ends} == expected
    edited.free()


def test_borders_follow_the_level_and_the_modifiers(analyzed):
    at_default = lines_of(analyzed)
    bpy.ops.eigenparts.segment(level=1)
    assert 0 < len(lines_of(analyzed)) < len(at_default)
    analyzed.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.eigenparts.segment()
    bpy.context.view_layer.update()
    assert len(lines_of(analyzed)) == 2 * len(at_default)


def test_one_part_has_no_borders(analyzed):
    bpy.ops.eigenparts.segment(level=0)
    assert len(lines_of(analyzed)) == 0
