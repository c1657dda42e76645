"""The command ``segment``: formats, the report, and one bad file that does not stop the rest."""

import shutil

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, analyze
from examples import humanoid
from tests.cli.files import add_object, write_off
from tests.shapes import icosphere, joined, star
from tools.extension import load_extension

EXPORTERS = {
    ".obj": lambda path: bpy.ops.wm.obj_export(filepath=path),
    ".ply": lambda path: bpy.ops.wm.ply_export(filepath=path),
    ".stl": lambda path: bpy.ops.wm.stl_export(filepath=path),
    ".glb": lambda path: bpy.ops.export_scene.gltf(filepath=path),
    ".fbx": lambda path: bpy.ops.export_scene.fbx(filepath=path),
    ".blend": lambda path: bpy.ops.wm.save_as_mainfile(filepath=path, copy=True),
}


@pytest.fixture(params=list(EXPORTERS))
def star_file(request, tmp_path):
    """The star in a format of Blender's."""
    add_object(star(5, 3))
    path = tmp_path / f"star{request.param}"
    EXPORTERS[request.param](str(path))
    return path


def test_every_format_is_read_and_written_back(run, star_file):
    code, report, errors = run("segment", star_file, "--json")
    (row,), suffix = report["files"][0]["objects"], star_file.suffix
    assert (code, errors) == (0, [])
    assert [part["name"] for part in row["parts"]] == ["body", "part_1", "part_2", "part_3", "part_4", "part_5"]
    written = star_file.with_name("star_stl_parts.blend" if suffix == ".stl" else f"star_parts{suffix}")
    assert report["files"][0]["output"] == str(written)
    assert written.stat().st_size > 0


def test_materials_hold_the_parts_where_the_format_knows_no_attributes(run, tmp_path):
    add_object(star(5, 3))
    EXPORTERS[".obj"](str(tmp_path / "star.obj"))
    _, report, _ = run("segment", tmp_path / "star.obj", "--json")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.obj_import(filepath=str(tmp_path / "star_parts.obj"))
    mesh = bpy.context.selected_objects[0].data
    counts = np.bincount([polygon.material_index for polygon in mesh.polygons])
    by_name = {material.name: count for material, count in zip(mesh.materials, counts.tolist(), strict=True)}
    assert by_name == {part["name"]: part["faces"] for part in report["files"][0]["objects"][0]["parts"]}


def test_each_loose_part_is_divided_by_itself_if_wanted(run, tmp_path):
    small = star(3, 3)
    write_off(joined(star(5, 3), TriangleMesh(0.7 * small.vertices + [6, 0, 0], small.triangles)), tmp_path / "two.off")
    n_parts = {}
    for shells in ("bridged", "largest", "separate"):
        _, report, _ = run("segment", tmp_path / "two.off", "--shells", shells, "--json")
        n_parts[shells] = len(report["files"][0]["objects"][0]["parts"])
        assert report["files"][0]["settings"]["shells"] == shells
    assert n_parts == {"bridged": 6, "largest": 6, "separate": 6 + 4}


def test_borders_are_along_edges_or_exact(run, tmp_path):
    write_off(star(5, 3), tmp_path / "star.off")
    faces = {}
    for borders in ("edges", "exact"):
        _, report, _ = run("segment", tmp_path / "star.off", "--borders", borders, "--json")
        faces[borders] = [part["faces"] for part in report["files"][0]["objects"][0]["parts"]]
        assert report["files"][0]["settings"]["borders"] == borders
    assert len(faces["edges"]) == len(faces["exact"]) == 6
    assert faces["edges"] != faces["exact"]


def test_a_blend_file_keeps_what_the_panel_needs(run, tmp_path):
    add_object(star(5, 3))
    EXPORTERS[".blend"](str(tmp_path / "star.blend"))
    run("segment", tmp_path / "star.blend", "--level", 2)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "star_parts.blend"))
    assert bpy.data.objects["star"].data["eigenparts_state"]["level"] == 2


def test_colours_of_an_off_file_tell_the_parts_of_the_engine(run, star_off, tmp_path):
    run("segment", star_off, "--output", tmp_path / "new folder")
    lines = (tmp_path / "new folder" / "star_parts.off").read_text().splitlines()
    n_vertices, n_faces = map(int, lines[1].split()[:2])
    colours = [tuple(line.split()[4:]) for line in lines[2 + n_vertices :]]
    _, of_colour = np.unique(colours, axis=0, return_inverse=True)
    mesh = star(5, 3)
    labels = analyze(TriangleMesh(np.float32(mesh.vertices), mesh.triangles)).segment().labels
    assert len(colours) == n_faces
    assert len(set(zip(of_colour.reshape(-1).tolist(), labels.tolist(), strict=True))) == 6


def test_the_report_adds_up(run, star_off, tmp_path):
    code, report, _ = run("segment", star_off, "--parts", 4, "--output", tmp_path, "--json")
    row = report["files"][0]["objects"][0]
    mesh = star(5, 3)
    assert (code, report["version"]) == (0, 1)
    assert row["elements"] == "cubic"
    assert len(row["parts"]) == 4
    assert sum(part["faces"] for part in row["parts"]) == len(mesh.triangles)
    assert sum(part["area"] for part in row["parts"]) == pytest.approx(mesh.areas.sum(), rel=1e-5)


@pytest.mark.parametrize(("mode", "n_parts"), [("nested", 3), ("features", 4)])
def test_the_mode_decides_about_blunt_ends(run, tmp_path, mode, n_parts):
    """A ball with two arms, a bump, and nothing else: the bump is a feature, but it does not stand out."""
    mesh = star(2, 4)
    bump = np.exp(-6 * (1 - icosphere(4).vertices[:, 2]))
    add_object(TriangleMesh(mesh.vertices * (1 + 0.5 * bump[:, None]), mesh.triangles))
    EXPORTERS[".ply"](str(tmp_path / "bumpy.ply"))
    _, report, _ = run("segment", tmp_path / "bumpy.ply", "--threshold", 1e-3, "--mode", mode, "--json")
    assert len(report["files"][0]["objects"][0]["parts"]) == n_parts


def test_joints_and_twins_are_in_the_report(run, tmp_path):
    character = humanoid(6000)
    add_object(TriangleMesh(character.vertices, character.triangles))
    EXPORTERS[".ply"](str(tmp_path / "humanoid.ply"))
    n_parts = {}
    for joints in ([], ["--joints"], ["--no-joints"]):
        _, report, _ = run("segment", tmp_path / "humanoid.ply", *joints, "--json")
        parts = report["files"][0]["objects"][0]["parts"]
        n_parts[report["files"][0]["settings"]["mode"]] = len(parts)
        mirror = {part["id"]: part["mirror"] for part in parts}
        assert sum(twin is not None and mirror[twin] == part for part, twin in mirror.items()) >= 4
    assert n_parts[None] == n_parts["jointed"] > n_parts["nested"]


def test_one_bad_file_does_not_stop_the_rest(run, star_off, tmp_path):
    broken = tmp_path / "broken.off"
    broken.write_text("OFF\n3 1 0\n0 0 0\n")
    good = shutil.copy(star_off, tmp_path / "good.off")
    missing, odd = tmp_path / "missing.obj", tmp_path / "notes.txt"
    code, lines, errors = run("segment", broken, missing, odd, good)
    assert code == 1
    assert len(lines) == 1
    assert "good.off: good: 6 parts" in lines[0]
    assert [line.split(": ", 1)[0] for line in errors] == [str(broken), str(missing), str(odd)]
    assert [line.rstrip()[-1] for line in errors] == ["."] * 3


def test_one_bad_object_does_not_stop_the_others_of_its_file(run, tmp_path):
    add_object(star(5, 3))
    point = add_object(icosphere(0), "point").data
    point.vertices.foreach_set("co", np.zeros(3 * len(point.vertices)))
    path = tmp_path / "two.blend"
    EXPORTERS[".blend"](str(path))
    code, report, errors = run("segment", path, "--json")
    assert code == 1
    assert len(errors) == 1
    assert "point: The faces of the mesh have no area" in errors[0]
    assert [len(row.get("parts", [])) for row in report["files"][0]["objects"]] == [0, 6]
    assert (tmp_path / "two_parts.blend").exists()


def test_shapes_of_bones_are_no_bad_objects(run, tmp_path):
    """They are meshes of edges, and every rigged character has some."""
    add_object(star(5, 3))
    EXPORTERS[".blend"](str(tmp_path / "character.blend"))
    shape = bpy.data.meshes.new("shape")
    shape.from_pydata([[0, 0, 0], [1, 0, 0]], [[0, 1]], [])
    bpy.data.objects.new("shape", shape).use_fake_user = True
    EXPORTERS[".blend"](str(tmp_path / "rigged.blend"))
    code, report, _ = run("segment", tmp_path / "character.blend", tmp_path / "rigged.blend", "--json")
    assert code == 0
    assert [[row["name"] for row in file["objects"]] for file in report["files"]] == [["star"], ["star"]]


def test_an_object_that_shares_its_mesh_can_be_chosen_by_either_name(run, tmp_path):
    bpy.context.collection.objects.link(bpy.data.objects.new("twin", add_object(star(5, 3)).data))
    EXPORTERS[".blend"](str(tmp_path / "twins.blend"))
    for name in ("star", "twin"):
        code, report, _ = run("segment", tmp_path / "twins.blend", "--object", name, "--json")
        assert (code, len(report["files"][0]["objects"])) == (0, 1)


def test_paths_are_relative_to_where_a_script_has_gone(run, tmp_path, monkeypatch):
    add_object(star(5, 3))
    EXPORTERS[".blend"](str(tmp_path / "star.blend"))
    monkeypatch.chdir(tmp_path)
    code, lines, _ = run("segment", "star.blend")
    assert code == 0
    assert lines[0].endswith("written to star_parts.blend")
    assert (tmp_path / "star_parts.blend").exists()


def test_an_object_can_be_chosen(run, tmp_path):
    add_object(star(5, 3), "star")
    add_object(icosphere(2), "ball")
    path = tmp_path / "two.blend"
    EXPORTERS[".blend"](str(path))
    _, report, _ = run("segment", path, "--object", "ball", "--json")
    assert [row["name"] for row in report["files"][0]["objects"]] == ["ball"]
    code, _, errors = run("segment", path, "--object", "cube")
    assert (code, len(errors)) == (1, 1)
    assert "no mesh object 'cube'; there are ball, star" in errors[0]


@pytest.mark.parametrize("field", ["1", "diffusion", "height"])
def test_every_kind_of_field_can_be_named(run, tmp_path, field):
    add_object(star(5, 3))
    attribute = bpy.data.meshes["star"].attributes.new("height", "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.float32(np.linalg.norm(star(5, 3).vertices, axis=1)))
    EXPORTERS[".blend"](str(tmp_path / "star.blend"))
    assert run("segment", tmp_path / "star.blend", "--field", field)[0] == 0


def test_a_level_that_does_not_exist_is_an_error_of_that_file(run, star_off, tmp_path):
    code, lines, errors = run("segment", star_off, "--level", 99, "--output", tmp_path)
    assert (code, lines, len(errors)) == (1, [], 1)
    assert "Level 99 does not exist" in errors[0]
    assert list(tmp_path.iterdir()) == []


def test_wrong_arguments_are_explained_with_exit_code_2(run, star_off):
    assert run("segment", star_off, "--level", 1, "--parts", 2)[0] == 2
    assert run("dissolve", star_off)[0] == 2
    assert run("--help")[0] == 0


def test_the_extension_can_be_switched_on_and_off_around_a_command(run, star_off, tmp_path):
    """No module of the command line may be called like one of its functions."""
    extension = load_extension()
    for _ in range(2):
        extension.register()
        assert run("segment", star_off, "--output", tmp_path)[0] == 0
        extension.unregister()
