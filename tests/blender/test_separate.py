"""Separate: an object for each part, with everything its owner had."""

import bpy
import numpy as np
import pytest

from tests.blender.conftest import corner_normals_of, give_custom_normals, values_of


@pytest.fixture
def rigged(analyzed):
    """The star on an armature, with a group, a shape key, a material and a modifier."""
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.collection.objects.link(rig)
    rig.location.x = 3.0
    analyzed.parent = rig
    analyzed.modifiers.new("Armature", "ARMATURE").object = rig
    analyzed.vertex_groups.new(name="bone").add(list(range(len(analyzed.data.vertices))), 0.5, "REPLACE")
    analyzed.shape_key_add(name="Basis")
    key = analyzed.shape_key_add(name="moved")
    for point in key.data:
        point.co.z += 2.0
    return analyzed


def separate():
    before = set(bpy.data.objects)
    assert bpy.ops.eigenparts.separate() == {"FINISHED"}
    return [bpy.context.object, *sorted(set(bpy.data.objects) - before, key=lambda obj: obj.name)]


def test_every_face_goes_to_the_object_of_its_part(analyzed):
    counts = np.bincount(values_of(analyzed.data, "part")).tolist()
    pieces = separate()
    assert [len(piece.data.polygons) for piece in pieces] == counts
    assert [piece.name for piece in pieces] == ["star", *(f"star Part {part}" for part in range(1, 6))]
    assert [set(values_of(piece.data, "part")) for piece in pieces] == [{part} for part in range(6)]


def test_modifiers_parents_groups_and_shape_keys_are_kept(rigged):
    for piece in separate():
        assert piece.parent.name == "rig"
        assert piece.modifiers["Armature"].object.name == "rig"
        assert {entry.weight for vertex in piece.data.vertices for entry in vertex.groups} == {0.5}
        assert [group.name for group in piece.vertex_groups] == ["bone"]
        basis, moved = piece.data.shape_keys.key_blocks
        shift = [point.co.z - first.co.z for first, point in zip(basis.data, moved.data, strict=True)]
        np.testing.assert_allclose(shift, 2.0, rtol=1e-5)


def test_the_pieces_cover_the_surface_and_carry_no_stray_vertices(rigged):
    area = sum(polygon.area for polygon in rigged.data.polygons)
    pieces = separate()
    assert sum(polygon.area for piece in pieces for polygon in piece.data.polygons) == pytest.approx(area)
    for piece in pieces:
        used = {vertex for polygon in piece.data.polygons for vertex in polygon.vertices}
        assert len(used) == len(piece.data.vertices)


def test_another_object_with_the_same_mesh_is_not_touched(analyzed):
    other = bpy.data.objects.new("other", analyzed.data)
    n_faces = len(analyzed.data.polygons)
    separate()
    assert len(other.data.polygons) == n_faces


def test_a_piece_can_be_analyzed_again(analyzed):
    pieces = separate()
    bpy.context.view_layer.objects.active = pieces[1]
    assert bpy.ops.eigenparts.analyze() == {"FINISHED"}


def test_one_part_is_not_separated(analyzed):
    bpy.ops.eigenparts.segment(level=0)
    with pytest.raises(RuntimeError, match="nothing to separate"):
        bpy.ops.eigenparts.separate()
    assert len(bpy.data.objects) == 1


def test_undo_brings_the_whole_back(analyzed):
    window = bpy.context.window_manager.windows[0]
    n_faces = len(analyzed.data.polygons)
    with bpy.context.temp_override(window=window, screen=window.screen):
        bpy.ops.ed.undo_push(message="analyzed")
        bpy.ops.eigenparts.separate()
        bpy.ops.ed.undo_push(message="separated")
        bpy.ops.ed.undo()
    assert [obj.name for obj in bpy.data.objects] == ["star"]
    assert len(bpy.data.objects["star"].data.polygons) == n_faces


def test_custom_normals_stay_along_the_borders(analyzed):
    """Blender stores them relative to the faces around a vertex, of which a piece has some only."""
    give_custom_normals(analyzed.data)
    for piece in separate():
        np.testing.assert_allclose(*corner_normals_of(piece.data), atol=0.03)


def test_an_object_that_the_view_layer_has_not_is_separated_by_a_script(analyzed):
    hidden = bpy.data.collections.new("hidden")
    bpy.context.scene.collection.children.link(hidden)
    hidden.objects.link(analyzed)
    bpy.context.scene.collection.objects.unlink(analyzed)
    bpy.context.view_layer.layer_collection.children["hidden"].exclude = True
    n_faces = len(analyzed.data.polygons)
    with bpy.context.temp_override(object=analyzed):
        assert bpy.ops.eigenparts.separate() == {"FINISHED"}
    assert len(hidden.objects) == 6
    assert sum(len(obj.data.polygons) for obj in hidden.objects) == n_faces
