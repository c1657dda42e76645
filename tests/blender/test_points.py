"""Pairs of points: given, kept with the scene, and kept to by Register and Transfer; the clicks need a window."""

import bpy
import numpy as np
import pytest
from mathutils import Vector

from tests.blender.conftest import add_object, values_of
from tests.compute.registration.shapes import lumpy_ball, shuffled

ARMS = np.array([(np.cos(angle), np.sin(angle), 0.3) for angle in 2 * np.pi * np.arange(5) / 5])
STAR = tuple((tuple(arm), 1.5, 0.25) for arm in ARMS)


@pytest.fixture
def stars():
    """Two stars of five equal arms; the first is active, the second has other numbers."""
    first = lumpy_ball(3, STAR)
    mesh, order = shuffled(first)
    copy = add_object(mesh.vertices, mesh.triangles, "copy")
    copy["order"] = order.tolist()
    return add_object(first.vertices, first.triangles, "star"), copy


def tip(obj, arm):
    places = values_of(obj.data, "position", 3, np.float32, "vector")
    return int(np.linalg.norm(places - 3 * ARMS[arm % 5], axis=1).argmin())


def add(source, source_vertex, target, target_vertex):
    return bpy.ops.eigenparts.add_point_pair(
        source=source.name, source_vertex=source_vertex, target=target.name, target_vertex=target_vertex
    )


def pairs():
    return [
        (row.source.name, row.source_vertex, row.target.name, row.target_vertex)
        for row in bpy.context.scene.eigenparts_points
    ]


def face_at(obj, vertex):
    return next(polygon.index for polygon in obj.data.polygons if vertex in polygon.vertices)


@pytest.mark.parametrize("turn", [1, 3])
@pytest.mark.parametrize("is_swapped", [False, True])
def test_one_pair_tells_register_which_arm_is_which(stars, turn, is_swapped):
    """Whichever of the two meshes was clicked first."""
    star, copy = stars
    ends = (star, tip(star, turn)), (copy, tip(copy, 0))
    first, second = ends[::-1] if is_swapped else ends
    assert add(*first, *second) == {"FINISHED"}
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.register_selected()
    labels = [values_of(obj.data, "part") for obj in stars]
    for arm in range(5):
        wanted = labels[0][face_at(star, tip(star, arm + turn))]
        assert labels[1][face_at(copy, tip(copy, arm))] == wanted > 0


def test_transfer_keeps_points_exactly(stars):
    star, copy = stars
    group = star.vertex_groups.new(name="mark")
    vertex = tip(star, 2)
    group.add([vertex], 1.0, "REPLACE")
    add(star, vertex, copy, tip(copy, 0))
    bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    weights = {v.index: g.weight for v in copy.data.vertices for g in v.groups}
    assert weights[tip(copy, 0)] == 1
    assert max(weights, key=weights.get) == tip(copy, 0)


def test_a_wrong_point_is_told_by_its_number(stars, capfd):
    star, copy = stars
    other = add_object(lumpy_ball(2).vertices, lumpy_ball(2).triangles, "other")
    add(star, 0, other, 0)
    order = np.array(copy["order"])
    for vertex in (tip(copy, 0), tip(copy, 1)):
        add(star, int(order[vertex]), copy, vertex)
    add(star, tip(star, 4), copy, tip(copy, 2))
    other.select_set(False)
    bpy.context.view_layer.objects.active = star
    bpy.ops.eigenparts.analyze()
    bpy.ops.eigenparts.register_selected()
    told = capfd.readouterr().out
    assert "copy: Point 4 contradicts everything else" in told
    assert told.count("contradicts") == 1


def test_a_changed_mesh_is_told_of_before_anything_is_done(stars):
    star, copy = stars
    star.vertex_groups.new(name="mark").add([0], 1.0, "REPLACE")
    add(star, 5, copy, 7)
    copy.data.vertices.add(1)
    with pytest.raises(RuntimeError, match="Point 1 was given before the vertices of copy changed"):
        bpy.ops.eigenparts.register_selected()
    with pytest.raises(RuntimeError, match="Point 1 was given before the vertices of copy changed"):
        bpy.ops.eigenparts.transfer(layers={"GROUPS"})
    bpy.ops.eigenparts.remove_point_pair(number=1)
    assert pairs() == []


def test_points_are_saved_with_the_scene_and_follow_names(stars, tmp_path):
    star, copy = stars
    add(star, 5, copy, 7)
    copy.name = "renamed"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "points.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "points.blend"))
    assert pairs() == [("star", 5, "renamed", 7)]


def test_points_are_undone_and_redone(stars):
    bpy.ops.ed.undo_push()
    add(*((stars[0]), 5, stars[1], 7))
    bpy.ops.ed.undo_push()
    bpy.ops.ed.undo()
    assert pairs() == []
    bpy.ops.ed.redo()
    assert pairs() == [("star", 5, "copy", 7)]


def test_points_are_removed_one_by_one_or_all(stars):
    for vertex in range(3):
        add(stars[0], vertex, stars[1], vertex)
    bpy.ops.eigenparts.remove_point_pair(number=2)
    assert [vertex for _, vertex, _, _ in pairs()] == [0, 2]
    bpy.ops.eigenparts.clear_point_pairs()
    assert pairs() == []
    assert not bpy.ops.eigenparts.clear_point_pairs.poll()


@pytest.mark.parametrize(
    ("pair", "sentence"),
    [
        (("star", 0, "star", 1), "Both points are on the same mesh"),
        (("star", 0, "nobody", 1), 'There is no mesh object "nobody" here'),
        (("star", 642, "copy", 1), "star has no vertex 642; it has 642"),
        (("star", 1, "copy", 3), "Point 1 is at one of these vertices"),
        (("copy", 2, "star", 9), "Point 1 is at one of these vertices"),
    ],
)
def test_what_is_no_pair_is_refused(stars, pair, sentence):
    add(stars[0], 1, stars[1], 2)
    names = ("source", "source_vertex", "target", "target_vertex")
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.eigenparts.add_point_pair(**dict(zip(names, pair, strict=True)))
    assert pairs() == [("star", 1, "copy", 2)]


def test_a_pair_that_is_not_there_cannot_be_removed(stars):
    with pytest.raises(RuntimeError, match="no pair of points with the number 1"):
        bpy.ops.eigenparts.remove_point_pair(number=1)


@pytest.mark.parametrize("modifier", [None, "MIRROR", "SUBSURF", "DISPLACE"])
def test_the_vertex_under_the_mouse_is_taken(stars, modifier):
    from eigenparts.operators.registration.add_point_pair import point_under

    star, copy = stars
    copy.hide_set(True)
    if modifier:
        star.modifiers.new("later", modifier)
    star.location = 1, 2, 3
    bpy.context.view_layer.update()
    vertex = tip(star, 1)
    place = star.matrix_world @ star.data.vertices[vertex].co
    outward = Vector((*ARMS[1][:2], 0.3)).normalized()
    end = point_under(bpy.context, place + 5 * outward, -outward)
    assert (end.obj, end.n_vertices) == (star, 642)
    away = (star.matrix_world @ star.data.vertices[end.vertex].co - place).length
    assert away < 0.15


def test_a_deleted_object_leaves_its_points_without_effect(stars):
    star, copy = stars
    add(star, 5, copy, 7)
    bpy.data.objects.remove(copy)
    from eigenparts.operators.mesh_state.point_pairs import numbered_pairs

    assert list(numbered_pairs(bpy.context)) == []
    bpy.ops.eigenparts.remove_point_pair(number=1)
    assert len(bpy.context.scene.eigenparts_points) == 0
