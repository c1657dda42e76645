"""Points on the command line: a file of pairs of vertices that belong together."""

import json

import bpy
import numpy as np
import pytest

from tests.cli.files import add_object, write_blend, write_off
from tests.compute.registration.shapes import lumpy_ball


def arms(turn):
    """Return where five arms are in a star that is turned by an angle."""
    return np.array([(np.cos(angle), np.sin(angle), 0.3) for angle in turn + 2 * np.pi * np.arange(5) / 5])


ARMS = arms(0.0)


@pytest.fixture(scope="module")
def stars(tmp_path_factory):
    """Files with two stars of five equal arms, other triangles on each, and the tips of the arms of each."""
    folder = tmp_path_factory.mktemp("stars")
    paths, tips = [], []
    for name, turned in (("star", ARMS), ("copy", arms(0.5))):
        mesh = lumpy_ball(3, tuple((tuple(arm), 1.5, 0.25) for arm in turned))
        paths.append(write_off(mesh, folder / f"{name}.off"))
        tips.append([int(np.linalg.norm(mesh.vertices - 3 * arm, axis=1).argmin()) for arm in turned])
    return *paths, *tips


def write_points(path, pairs):
    path.write_text(json.dumps({"points": pairs}))
    return path


@pytest.mark.parametrize("turn", [0, 2])
def test_one_pair_tells_which_arm_is_which(run, stars, tmp_path, turn):
    star, copy, tips, copy_tips = stars
    points = write_points(tmp_path / "points.json", [[tips[turn], copy_tips[0]]])
    arguments = ("--source", star, "--points", points, "--output", tmp_path, "--json")
    code, report, errors = run("register", star, copy, *arguments)
    assert (code, errors) == (0, [])
    assert report["files"][1]["settings"]["points"] == [[tips[turn], copy_tips[0]]]
    assert report["files"][1]["objects"][0]["confidence"] > 0.5
    colours = [face_colours(tmp_path / f"{name}_parts.off") for name in ("star", "copy")]
    at_tips = colours[0][tips[turn]], colours[1][copy_tips[0]]
    assert at_tips[0] == at_tips[1]


def face_colours(path):
    """Return the colour of a face at each vertex."""
    lines = path.read_text().splitlines()
    faces = [line.split() for line in lines if line.startswith("3 ")]
    return {int(vertex): tuple(face[4:]) for face in faces for vertex in face[1:4]}


def test_a_wrong_point_is_told_with_the_object(run, stars, tmp_path):
    star, copy, tips, copy_tips = stars
    pairs = [[tips[k], copy_tips[k]] for k in range(4)] + [[tips[2] + 1, copy_tips[4]]]
    points = write_points(tmp_path / "points.json", pairs)
    _, report, _ = run("register", copy, "--source", star, "--points", points, "--output", tmp_path, "--json")
    (row,) = report["files"][0]["objects"]
    assert any(warning.startswith("copy: Point 5 contradicts") for warning in row["warnings"])
    assert row["confidence"] < 0.5


def test_a_transfer_keeps_points_exactly(run, stars, tmp_path):
    _, copy, tips, copy_tips = stars
    obj = add_object(lumpy_ball(3, tuple((tuple(arm), 1.5, 0.25) for arm in ARMS)))
    obj.vertex_groups.new(name="Tip").add([tips[1]], 1.0, "REPLACE")
    source = write_blend(tmp_path / "source.blend")
    points = write_points(tmp_path / "points.json", [[tips[1], copy_tips[0]]])
    assert run("transfer", copy, "--source", source, "--points", points, "--output", tmp_path)[0] == 0
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "copy_off_transferred.blend"))
    weights = [sum(group.weight for group in vertex.groups) for vertex in bpy.data.objects["copy"].data.vertices]
    assert weights[copy_tips[0]] == 1


def test_a_mesh_that_points_do_not_fit_costs_no_other_of_its_file(run, stars, tmp_path):
    star, _, tips, _ = stars
    smaller, same = (lumpy_ball(level, tuple((tuple(arm), 1.5, 0.25) for arm in ARMS)) for level in (2, 3))
    add_object(smaller, "smaller")
    add_object(same, "same")
    path = write_blend(tmp_path / "two.blend")
    # The smaller one has 162 vertices.
    points = write_points(tmp_path / "points.json", [[tips[1], tips[1]]])
    code, report, _ = run("register", path, "--source", star, "--points", points, "--json")
    rows = {row["name"]: row for row in report["files"][0]["objects"]}
    assert code == 1
    assert "Point 1 names vertex" in rows["smaller"]["error"]
    assert rows["same"]["confidence"] > 0.5


def test_a_folder_is_no_file_of_points(run, stars, tmp_path):
    code, _, errors = run("register", stars[1], "--source", stars[0], "--points", tmp_path, "--output", tmp_path)
    assert code == 1
    assert "this is a folder; name the file in it" in errors[0]


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (None, "there is no such file"),
        ("nothing", "this is no file of points"),
        ("[[1, 2]]", "this is no file of points"),
        ('{"points": 7}', "this is no file of points"),
        ('{"points": [[1, 2, 3]]}', "this is no file of points"),
        ('{"points": []}', "no pairs of whole numbers"),
        ('{"points": [[1.5, 2]]}', "no pairs of whole numbers"),
        ('{"points": [[true, 2]]}', "no pairs of whole numbers"),
        ('{"points": [["1", "2"]]}', "no pairs of whole numbers"),
        ('{"points": [[1, 99999]]}', "Point 1 names vertex 99999 of the target, which has vertices 0 to 641."),
        ('{"points": [[1, 2], [1, 3]]}', "Vertex 1 of the source is in two pairs of points"),
        ('{"points": [[1, 123456789012345678901234567890]]}', "pairs of whole numbers"),
    ],
)
@pytest.mark.parametrize("command", ["register", "transfer"])
def test_what_is_no_file_of_points_is_told_in_a_sentence(run, stars, tmp_path, command, content, sentence):
    star, copy, *_ = stars
    path = tmp_path / "points.json"
    if content is not None:
        path.write_text(content)
    if command == "transfer":
        add_object(lumpy_ball(3)).vertex_groups.new(name="One").add([0], 1.0, "REPLACE")
        star = write_blend(tmp_path / "source.blend")
    code, _, errors = run(command, copy, "--source", star, "--points", path, "--output", tmp_path)
    assert (code, len(errors)) == (1, 1)
    assert sentence in errors[0]


def test_processes_are_given_the_points(run, stars, tmp_path):
    star, copy, tips, copy_tips = stars
    points = write_points(tmp_path / "points.json", [[tips[0], copy_tips[0]]])
    arguments = ("--source", star, "--points", points, "--output", tmp_path, "--jobs", 1, "--json")
    code, report, _ = run("register", copy, *arguments)
    assert code == 0
    assert report["files"][0]["settings"]["points"] == [[tips[0], copy_tips[0]]]


def test_a_batch_does_files_again_whose_points_have_changed(run, stars, tmp_path):
    star, copy, tips, copy_tips = stars
    folder = tmp_path / "files"
    folder.mkdir()
    (folder / "copy.off").write_bytes(copy.read_bytes())
    skipped = []
    for pair in ([tips[0], copy_tips[0]], [tips[0], copy_tips[0]], [tips[1], copy_tips[0]]):
        points = write_points(tmp_path / "points.json", [pair])
        code, report, _ = run("batch", folder, "--source", star, "--points", points, "--json")
        assert code == 0
        skipped.append(report["files"][0].get("skipped", False))
    assert skipped == [False, True, False]
