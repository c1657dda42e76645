"""What cannot be analyzed is refused in a sentence, and nothing is changed."""

import sys

import bpy
import pytest

from tests.blender.conftest import add_object, everything_on


def nothing_active(star):
    bpy.context.view_layer.objects.active = None


def a_camera(star):
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(camera)
    bpy.context.view_layer.objects.active = camera


def edit_mode(star):
    add_object(star.vertices, star.triangles)
    bpy.ops.object.mode_set(mode="EDIT")


def an_empty_mesh(star):
    add_object([], [])


def only_vertices(star):
    add_object(star.vertices, [])


def no_area(star):
    add_object(0 * star.vertices, star.triangles)


def a_coordinate_that_is_no_number(star):
    add_object(star.vertices, star.triangles).data.vertices[3].co.x = float("nan")


def a_linked_mesh(star, folder):
    add_object(star.vertices, star.triangles)
    path = str(folder / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (source, target):
        target.objects = source.objects
    bpy.context.collection.objects.link(target.objects[0])
    bpy.context.view_layer.objects.active = target.objects[0]


@pytest.mark.parametrize(
    ("situation", "sentence"),
    [
        (nothing_active, "Select a mesh object"),
        (a_camera, "Select a mesh object"),
        (edit_mode, "Leave edit mode"),
        (an_empty_mesh, "no faces"),
        (only_vertices, "no faces"),
        (no_area, "no area"),
        (a_coordinate_that_is_no_number, "not a finite number"),
    ],
)
def test_analyze_says_why_it_cannot(star, situation, sentence):
    situation(star)
    mesh = getattr(bpy.context.object, "data", None)
    before = everything_on(mesh) if isinstance(mesh, bpy.types.Mesh) else None
    with pytest.raises(RuntimeError, match=sentence):
        bpy.ops.eigenparts.analyze()
    assert before is None or everything_on(mesh) == before


def test_a_linked_mesh_is_not_written_to(star, tmp_path):
    a_linked_mesh(star, tmp_path)
    with pytest.raises(RuntimeError, match="make it local"):
        bpy.ops.eigenparts.analyze()


def test_segment_needs_an_analysis(star_object):
    with pytest.raises(RuntimeError, match="Analyze the mesh first"):
        bpy.ops.eigenparts.segment(level=1)


def test_an_attribute_that_is_not_there_is_named(star_object):
    with pytest.raises(RuntimeError, match='no attribute "heat"'):
        bpy.ops.eigenparts.analyze(field="ATTRIBUTE", attribute="heat")


def test_an_eigenfunction_must_be_asked_for_that_exists(star_object):
    with pytest.raises(RuntimeError, match=r"\."):
        bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=10**6)
    assert "eigenparts_state" not in star_object.data


def test_a_fixed_boundary_needs_a_boundary(star_object):
    with pytest.raises(RuntimeError, match=r"(?i)boundary|closed"):
        bpy.ops.eigenparts.analyze(boundary="DIRICHLET")


def test_missing_scipy_is_explained(star_object, monkeypatch, extension):
    for name in [name for name in sys.modules if name.split(".")[0] == "scipy"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(extension.operators.messages.user_errors, "find_spec", lambda name: None)
    with pytest.raises(RuntimeError, match="needs scipy"):
        bpy.ops.eigenparts.analyze()
    assert extension.cli.main(["segment", "nothing.obj"]) == 1
