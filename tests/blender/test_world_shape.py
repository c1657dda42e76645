"""Shapes are read as they stand in the world: scale, shear and mirrors count, place, turn and size do not."""

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix, Vector

from tests.blender.conftest import add_object, values_of
from tests.blender.drawn import draw_panels
from tests.shapes import TriangleMesh
from tests.shapes import star as make_star

TURN = Euler((0.3, 0.5, 0.7)).to_matrix().to_4x4()


@pytest.fixture(scope="session")
def star():
    """Five arms, in few faces."""
    return make_star(n_arms=5, n_subdivisions=2)


@pytest.fixture
def analyzed(scene, star):
    """The star, analyzed with linear elements."""
    return scene(analyzed_star, star)


def analyzed_star(star):
    add_object(star.vertices, star.triangles)
    bpy.ops.eigenparts.analyze(order="1")


def add_standing(mesh, matrix, name="standing"):
    """Add an object with a matrix, whose mesh is such that it stands in the world as the given one, but turned."""
    linear = np.array(matrix.to_3x3())
    faces = mesh.triangles[:, ::-1] if np.linalg.det(linear) < 0 else mesh.triangles
    obj = add_object(mesh.vertices @ np.linalg.inv(linear).T, faces, name)
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    # Location, rotation and scale hold no shear, which a parent can give.
    obj.parent, obj.matrix_parent_inverse = parent, matrix
    bpy.context.view_layer.update()
    return obj


def scaled(*scale):
    return Matrix.Diagonal(scale).to_4x4()


SHEAR = scaled(1, 3, 0.5) @ TURN
STRETCHES = [
    scaled(1, 2, 0.25),
    scaled(-1, 1, 1),
    scaled(1, -4, 1),
    scaled(-2, -1, -1),
    SHEAR,
    scaled(1, 1, -1) @ SHEAR,
]


def told_in_panels():
    return " ".join(draw_panels())


def positions_in_world(obj, places):
    return np.array([obj.matrix_world @ Vector(place) for place in places])


@pytest.mark.parametrize("matrix", STRETCHES)
def test_what_is_equal_in_the_world_has_equal_parts(star, analyzed, matrix):
    expected = values_of(analyzed.data, "part")
    other = add_standing(star, matrix)
    bpy.ops.eigenparts.analyze(order="1")
    np.testing.assert_array_equal(values_of(other.data, "part"), expected)


@pytest.mark.parametrize("matrix", [TURN, scaled(7, 7, 7) @ TURN, scaled(1e-3, 1e-3, 1e-3), scaled(-1, -1, 1)])
def test_turns_and_size_change_no_bit_of_what_is_read(star_object, matrix):
    from eigenparts.operators.mesh_data.mesh_arrays import read_mesh, read_object

    star_object.matrix_basis = matrix
    read, expected = read_object(bpy.context, star_object, False), read_mesh(star_object.data)
    np.testing.assert_array_equal(read.vertices, expected.vertices)
    np.testing.assert_array_equal(read.triangles, expected.triangles)


def test_a_hundred_turned_parents_are_no_stretch(star_object):
    from eigenparts.operators.mesh_data.world_shape import stretch_of

    child = star_object
    for number in range(100):
        parent = bpy.data.objects.new("parent", None)
        bpy.context.collection.objects.link(parent)
        child.parent, parent.rotation_euler = parent, (number, 2 * number, 3 * number)
        child = parent
    assert stretch_of(star_object).is_none


def test_faces_look_outward_whatever_the_scale(star):
    from eigenparts.operators.mesh_data.mesh_arrays import read_object

    for matrix in STRETCHES:
        arrays = read_object(bpy.context, add_standing(star, matrix), False)
        a, b, c = arrays.vertices[arrays.triangles].swapaxes(0, 1)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0


@pytest.mark.parametrize("hide", [lambda obj: setattr(obj, "hide_viewport", True), lambda obj: obj.hide_set(True)])
def test_the_scale_of_hidden_objects_counts(star_object, hide):
    from eigenparts.operators.mesh_data.world_shape import stretch_of

    hide(star_object)
    star_object.scale = 1, 1, 8
    np.testing.assert_allclose(stretch_of(star_object).matrix, np.diag([0.5, 0.5, 4]), atol=1e-6)


@pytest.mark.parametrize("scale", [(1, 1, 0), (0, 0, 0), (1, 1, 1e-9), (float("nan"), 1, 1)])
def test_what_is_scaled_to_nothing_is_refused(star_object, scale):
    star_object.scale = scale
    with pytest.raises(RuntimeError, match="scaled to nothing"):
        bpy.ops.eigenparts.analyze(order="1")
    assert "part" not in star_object.data.attributes


@pytest.mark.parametrize("scale", [(1, 1, 2), (-1, 1, 1)])
def test_an_object_that_was_scaled_since_is_told(analyzed, scale):
    analyzed.scale = scale
    with pytest.raises(RuntimeError, match="scaled after it was analyzed"):
        bpy.ops.eigenparts.segment(level=1)
    assert "scaled after" in told_in_panels()
    analyzed.scale = 1, 1, 1
    bpy.ops.eigenparts.segment(level=1)
    assert "scaled after" not in told_in_panels()


def test_an_analysis_is_of_the_scale_it_was_made_with(star_object):
    star_object.scale = 1, -1, 2
    bpy.ops.eigenparts.analyze(order="1")
    star_object.rotation_euler, star_object.location = (1, 2, 3), (4, 5, 6)
    star_object.scale = 3, -3, 6
    bpy.ops.eigenparts.segment(level=1)
    star_object.scale = 1, 1, 2
    with pytest.raises(RuntimeError, match="scaled after it was analyzed"):
        bpy.ops.eigenparts.segment(level=1)


def test_size_alone_makes_no_other_shape(analyzed):
    analyzed.scale = 100, 100, 100
    bpy.ops.eigenparts.segment(level=1)
    assert "scaled" not in told_in_panels()


def test_linked_duplicates_at_another_scale_are_named(analyzed):
    other = analyzed.copy()
    bpy.context.collection.objects.link(other)
    other.name, other.scale = "flat", (1, 1, 0.1)
    bpy.context.view_layer.objects.active = other
    assert "star, too, which is scaled otherwise" in told_in_panels()
    bpy.ops.eigenparts.segment(level=1)
    bpy.context.view_layer.objects.active = analyzed
    bpy.ops.eigenparts.analyze(order="1")
    assert "scaled" not in told_in_panels()


@pytest.mark.parametrize("matrix", STRETCHES)
def test_curves_and_dots_lie_on_the_shape(star, analyzed, matrix):
    """They are those of the same shape that is not stretched."""
    bpy.ops.eigenparts.create_skeleton_curves(order="1")
    expected = points_of(bpy.context.object)
    other = add_standing(star, matrix)
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.create_skeleton_curves(order="1")
    np.testing.assert_allclose(points_of(bpy.context.object), expected, atol=2e-3)
    bpy.context.view_layer.objects.active = other
    bpy.ops.eigenparts.trace_complex(order="1")
    bpy.context.view_layer.update()
    dots = next(obj for obj in other.children if "Maximum" in obj.name)
    places = positions_in_world(dots, np.reshape(dots["places"], (-1, 3)))
    on_shape = positions_in_world(other, [vertex.co for vertex in other.data.vertices])
    assert np.linalg.norm(places[:, None] - on_shape, axis=2).min(axis=1).max() < 0.2
    # Round as they are, not flattened with the object.
    sizes = np.linalg.svd(np.array(dots.matrix_world.to_3x3()), compute_uv=False)
    np.testing.assert_allclose(sizes, sizes[0], rtol=1e-5)


def points_of(curve):
    bpy.context.view_layer.update()
    return positions_in_world(curve, [point.co.xyz for spline in curve.data.splines for point in spline.points])


@pytest.mark.parametrize("matrix", STRETCHES)
def test_bones_lie_in_the_shape_and_bind_it_where_it_stands(star, analyzed, matrix):
    bpy.ops.eigenparts.create_armature(order="1")
    expected = heads_of(bpy.context.object)
    other = add_standing(star, matrix)
    before = np.array(other.matrix_world)
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.create_armature(order="1")
    np.testing.assert_allclose(heads_of(bpy.context.object), expected, atol=2e-3)
    np.testing.assert_allclose(np.array(other.matrix_world), before, atol=1e-5)
    posed = other.evaluated_get(bpy.context.evaluated_depsgraph_get())
    places = positions_in_world(posed, [vertex.co for vertex in posed.data.vertices])
    np.testing.assert_allclose(places, star.vertices, atol=1e-4)
    sizes = np.linalg.svd(np.array(bpy.context.object.matrix_world.to_3x3()), compute_uv=False)
    np.testing.assert_allclose(sizes, sizes[0], rtol=1e-5)


def heads_of(armature):
    bpy.context.view_layer.update()
    # The root points up, which hangs on how the object is turned.
    return positions_in_world(armature, [bone.tail_local for bone in armature.data.bones if bone.parent])


def test_left_is_left_in_the_world():
    """Arms to the left and to the right: which is which does not hang on how the object came to stand so."""
    star, sides = make_star(n_arms=3, n_subdivisions=2, growth=0), []
    for flip in ((1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, -1, -1)):
        obj = add_object(star.vertices[:, [1, 0, 2]] * flip, star.triangles[:, :: -int(np.prod(flip))], "flipped")
        obj.scale = flip
        bpy.ops.eigenparts.analyze(order="1")
        bpy.ops.eigenparts.create_armature(order="1")
        armature = bpy.context.object
        bpy.context.view_layer.update()
        sides.append([(armature.matrix_world @ bone.tail_local).x > 0 for bone in left_bones(armature)])
    assert sides[0]
    assert all(all(lefts) and lefts == sides[0] for lefts in sides)


def left_bones(armature):
    return [bone for bone in armature.data.bones if bone.name.endswith(".L")]


@pytest.mark.parametrize("matrix", STRETCHES)
def test_borders_are_cut_where_they_are_on_the_shape(star, analyzed, matrix):
    bpy.ops.eigenparts.cut()
    expected = np.array([vertex.co for vertex in analyzed.data.vertices])
    other = add_standing(star, matrix)
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.cut()
    found = positions_in_world(other, [vertex.co for vertex in other.data.vertices])
    assert len(found) == len(expected)
    assert np.linalg.norm(found[:, None] - expected, axis=2).min(axis=1).max() < 1e-3


@pytest.mark.parametrize("matrix", STRETCHES)
def test_shape_keys_move_the_same_way_in_the_world(star, matrix):
    target = add_standing(TriangleMesh(star.vertices * [1, 1, 2], star.triangles), matrix)
    target.shape_key_add(name="Basis")
    source = add_object(star.vertices, star.triangles, "source")
    source.scale = 1, 1, 2
    for name, moved in (("Basis", 0), ("Bent", 0.2 * np.sin(star.vertices[:, [1, 2, 0]]))):
        key = source.shape_key_add(name=name)
        key.data.foreach_set("co", np.float32(star.vertices + moved).ravel())
    bpy.ops.eigenparts.transfer(layers={"SHAPE_KEYS"})
    bpy.context.view_layer.update()
    places = [
        positions_in_world(obj, [point.co for point in obj.data.shape_keys.key_blocks["Bent"].data])
        for obj in (source, target)
    ]
    np.testing.assert_allclose(places[1], places[0], atol=2e-2)


def test_softness_is_a_width_in_the_world(star_object):
    bpy.ops.eigenparts.analyze(order="1")
    bpy.ops.eigenparts.write_outputs(outputs={"VERTEX_GROUPS"}, softness=0.3)
    n_soft = count_soft(star_object)
    star_object.scale = 10, 10, 10
    bpy.ops.eigenparts.write_outputs(outputs={"VERTEX_GROUPS"}, softness=3)
    assert count_soft(star_object) == n_soft > 0


def count_soft(obj):
    return sum(len(vertex.groups) > 1 for vertex in obj.data.vertices)


def test_a_shape_that_was_sheared_by_a_parent_can_be_corrected(star):
    obj = add_standing(star, SHEAR)
    bpy.ops.eigenparts.analyze(order="1")
    n_parts = len(obj.data.eigenparts.rows)
    bpy.ops.eigenparts.split_part(part=1)
    bpy.ops.eigenparts.move_border(part=2, offset=0.05)
    assert len(obj.data.eigenparts.rows) == n_parts + 1


@pytest.mark.parametrize("values", [[1.0] * 8, [0.0] * 9, [float("nan")] * 9, "one", [1, 0, 0, 0, 1, 0, 0, 0, 1]])
def test_a_damaged_stretch_is_refused(analyzed, values):
    analyzed.data["eigenparts_state"]["stretch"] = values
    with pytest.raises(RuntimeError, match="damaged"):
        bpy.ops.eigenparts.segment(level=1)
    assert "damaged" in told_in_panels()
