"""Meshes of several loose parts in Blender: what the option does, and that all that follows knows of it."""

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, analyze
from tests.blender.conftest import add_object, values_of
from tests.shapes import icosphere, joined, star

LARGE, SMALL = star(n_arms=5, n_subdivisions=3), star(n_arms=3, n_subdivisions=3)
EYE = TriangleMesh(0.08 * icosphere(1).vertices + [6, 0, 0.75], icosphere(1).triangles)
TOGETHER = joined(LARGE, TriangleMesh(0.7 * SMALL.vertices + [6, 0, 0], SMALL.triangles), EYE)
ENDS = np.cumsum([len(LARGE.triangles), len(SMALL.triangles)])


@pytest.fixture
def apart(scene):
    """Two stars beside each other, each analyzed by itself, and an eye on the second."""
    return scene(stars_analyzed_apart)


def stars_analyzed_apart():
    add_object(TOGETHER.vertices, TOGETHER.triangles)
    bpy.ops.eigenparts.analyze(shells="SEPARATE")


def labels_of(obj):
    """Return the labels of the two stars and of the eye."""
    return np.split(values_of(obj.data, "part"), ENDS)


def body_of_second(obj):
    """Return the part that is left of the second star: most of its faces, as its arms are three."""
    return int(np.bincount(labels_of(obj)[1]).argmax())


def test_two_characters_in_one_mesh_get_each_their_arms(apart):
    first, second, eye = (set(labels.tolist()) for labels in labels_of(apart))
    assert (len(first), len(second)) == (6, 4)
    assert not first & second
    assert eye == {body_of_second(apart)}
    mesh = TriangleMesh(np.float32(TOGETHER.vertices), TOGETHER.triangles)
    expected = analyze(mesh, shells="separate").segment(mode="nested").labels
    np.testing.assert_array_equal(np.concatenate(labels_of(apart)), expected)


def test_a_file_knows_how_its_loose_parts_were_analyzed(apart, tmp_path):
    labels = values_of(apart.data, "part")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "apart.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "apart.blend"))
    obj = bpy.data.objects["star"]
    bpy.ops.eigenparts.segment(level=0)
    assert [len(set(some.tolist())) for some in labels_of(obj)] == [1, 1, 1]
    bpy.ops.eigenparts.segment()
    np.testing.assert_array_equal(values_of(obj.data, "part"), labels)
    bpy.ops.eigenparts.split_part(part=int(labels_of(obj)[1].max()), position=0.4)
    assert len(np.unique(labels_of(obj)[1])) == 5


def test_the_scene_keeps_the_option_for_the_window():
    settings = bpy.context.scene.eigenparts
    assert settings.shells == "BRIDGED"
    settings.shells = "SEPARATE"
    assert bpy.ops.eigenparts.analyze.get_rna_type().properties["shells"].default == "BRIDGED"


def test_the_largest_alone_is_divided_if_wanted():
    obj = add_object(TOGETHER.vertices, TOGETHER.triangles)
    bpy.ops.eigenparts.analyze(shells="LARGEST")
    first, second, _ = labels_of(obj)
    assert len(np.unique(first)) == 6
    assert set(second.tolist()) <= set(first.tolist())


def test_one_loose_part_can_have_a_level_of_its_own(apart):
    first, second, _ = labels_of(apart)
    bpy.ops.eigenparts.set_branch_level(part=body_of_second(apart), level=0)
    np.testing.assert_array_equal(labels_of(apart)[0], first)
    assert len(np.unique(labels_of(apart)[1])) == 1
    bpy.ops.eigenparts.clear_corrections()
    np.testing.assert_array_equal(labels_of(apart)[1], second)


@pytest.mark.parametrize(
    ("operator", "options"),
    [("move_border", {"offset": 0.1}), ("split_part", {"position": 0.5}), ("merge_parts", {"into": 0})],
)
def test_a_whole_loose_part_has_no_border_that_could_be_moved(apart, operator, options):
    before = values_of(apart.data, "part")
    with pytest.raises(RuntimeError, match=r"[a-z]\."):
        getattr(bpy.ops.eigenparts, operator)(part=body_of_second(apart), **options)
    np.testing.assert_array_equal(values_of(apart.data, "part"), before)


@pytest.mark.parametrize("method", ["INSERT", "EXISTING"])
def test_borders_are_cut_on_every_loose_part(apart, method):
    before = [len(np.unique(labels)) for labels in labels_of(apart)[:2]]
    bpy.ops.eigenparts.cut(method=method)
    parts = values_of(apart.data, "part")
    centres = np.array([polygon.center[0] for polygon in apart.data.polygons])
    assert [len(np.unique(parts[centres < 3.5])), len(np.unique(parts[centres > 3.5]))] == before
    assert (len(parts) > len(TOGETHER.triangles)) == (method == "INSERT")
    assert not apart.data.validate()


def test_a_separated_mesh_has_an_object_for_each_part_of_each_loose_part(apart):
    assert len(bpy.context.view_layer.objects) == 1
    bpy.ops.eigenparts.separate()
    assert len(bpy.context.view_layer.objects) == 6 + 4


def test_names_and_corrections_stay_when_it_is_analyzed_again(apart):
    row = next(row for row in apart.data.eigenparts.rows if row.part == body_of_second(apart))
    row.title = "Second"
    bpy.ops.eigenparts.split_part(part=int(labels_of(apart)[1].max()), position=0.4)
    labels = values_of(apart.data, "part")
    bpy.ops.eigenparts.analyze(shells="SEPARATE")
    np.testing.assert_array_equal(values_of(apart.data, "part"), labels)
    assert "Second" in [row.title for row in apart.data.eigenparts.rows]


@pytest.mark.parametrize("operator", ["register_selected", "create_armature"])
def test_what_needs_one_shape_says_so(apart, operator):
    add_object(TOGETHER.vertices, TOGETHER.triangles, "other")
    bpy.context.view_layer.objects.active = apart
    with pytest.raises(RuntimeError, match="Each loose part was analyzed by itself"):
        getattr(bpy.ops.eigenparts, operator)(order="1", shells="SEPARATE")
    assert len(bpy.data.objects) == 2
