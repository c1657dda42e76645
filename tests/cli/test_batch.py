"""The command ``batch``: all files of folders, what is finished is left alone, and nothing is half written."""

import gc
import io
import json
import os
import resource
import shutil

import bpy
import pytest

from tests.cli.files import add_object, write_blend, write_off
from tests.shapes import star


@pytest.fixture
def folder(tmp_path):
    """Three stars, one of them in a folder further down."""
    for name, n_arms in [("a.off", 3), ("b.off", 4), ("deep/down/c.off", 5)]:
        write_off(star(n_arms, 2), tmp_path / "in" / name)
    return tmp_path / "in"


def results_in(folder):
    return {str(path.relative_to(folder)): path.stat().st_mtime_ns for path in folder.rglob("*_parts.off")}


def test_results_keep_the_order_of_the_folders(run, folder, tmp_path):
    code, lines, progress = run("batch", folder, "--output", tmp_path / "out")
    assert (code, len(lines)) == (0, 3)
    assert sorted(results_in(tmp_path / "out")) == ["a_parts.off", "b_parts.off", "deep/down/c_parts.off"]
    assert progress[0] == "0 of 3 files"
    assert progress[-1].startswith("3 of 3 files")


def test_names_can_be_filtered(run, folder):
    run("batch", folder, "--glob", "deep/*/*.off", "--glob", "a*")
    assert sorted(results_in(folder)) == ["a_parts.off", "deep/down/c_parts.off"]


def test_finished_files_are_skipped(run, folder):
    _, first, _ = run("batch", folder, "--json")
    before = results_in(folder)
    code, second, progress = run("batch", folder, "--json")
    assert (code, results_in(folder)) == (0, before)
    assert [file.pop("skipped") for file in second["files"]] == [True] * 3
    assert second == first
    assert progress == ["0 of 0 files (3 finished before)"]
    run("batch", folder, "--again")
    assert all(results_in(folder)[name] > time for name, time in before.items())


@pytest.mark.parametrize(
    "change",
    [
        lambda folder: write_off(star(4, 3), folder / "a.off"),
        lambda folder: (folder / "a_parts.off").unlink(),
    ],
    ids=["other input", "no result"],
)
def test_what_would_come_out_otherwise_is_done_again(run, folder, change):
    run("batch", folder)
    before = results_in(folder)
    change(folder)
    assert run("batch", folder)[0] == 0
    after = results_in(folder)
    assert [name for name in after if after[name] != before[name]] == ["a_parts.off"]


def test_other_settings_make_other_results(run, folder):
    run("batch", folder)
    before = results_in(folder)
    _, report, _ = run("batch", folder, "--level", 1, "--json")
    assert [file["objects"][0]["level"] for file in report["files"]] == [1, 1, 1]
    assert set(results_in(folder).values()).isdisjoint(before.values())


def test_a_changed_reference_makes_other_results(run, folder, tmp_path):
    source = write_off(star(3, 2), tmp_path / "source.off")
    run("batch", folder, "--glob", "a.off", "--source", source)
    before = results_in(folder)
    run("batch", folder, "--glob", "a.off", "--source", source)
    assert results_in(folder) == before
    write_off(star(4, 2), source)
    run("batch", folder, "--glob", "a.off", "--source", source)
    assert results_in(folder) != before


def test_buffers_belong_to_a_gltf(run, tmp_path):
    add_object(star(3, 2))
    bpy.ops.export_scene.gltf(filepath=str(tmp_path / "star.gltf"), export_format="GLTF_SEPARATE")
    run("batch", tmp_path)
    before = (tmp_path / "star_gltf_parts.glb").stat().st_mtime_ns
    shutil.copy(tmp_path / "star.bin", tmp_path / "kept")
    with open(tmp_path / "star.bin", "r+b") as buffer:
        buffer.write(bytes(12))
    run("batch", tmp_path)
    assert (tmp_path / "star_gltf_parts.glb").stat().st_mtime_ns > before


def test_failed_files_are_tried_again(run, folder):
    (folder / "b.off").write_text("OFF\n3 1 0\n")
    code, lines, errors = run("batch", folder)
    assert (code, len(lines)) == (1, 2)
    assert sum(line.startswith(f"{folder / 'b.off'}: ") for line in errors) == 1
    write_off(star(4, 2), folder / "b.off")
    assert run("batch", folder)[0] == 0
    assert len(results_in(folder)) == 3


def test_no_result_takes_the_place_of_another(run, star_off, tmp_path):
    """The same name in two folders, one folder for results."""
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        shutil.copy(star_off, tmp_path / name / "star.off")
    files = [tmp_path / "one" / "star.off", tmp_path / "two" / "star.off"]
    code, lines, errors = run("segment", *files, "--output", tmp_path / "out")
    assert (code, len(lines), len(errors)) == (1, 1, 1)
    assert errors[0].startswith(f"{files[1]}: its result would replace that of {files[0]}")


@pytest.fixture
def little_room():
    """Files can hold 20 kB and no more."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    # Blender's own exporter of .glb leaves its file open when it fails.
    gc.collect()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".glb", ".blend"])
def test_a_result_that_finds_no_room_leaves_the_old_one(run, tmp_path, suffix, request):
    add_object(star(5, 3))
    write = {
        ".obj": lambda path: bpy.ops.wm.obj_export(filepath=path),
        ".ply": lambda path: bpy.ops.wm.ply_export(filepath=path),
        ".glb": lambda path: bpy.ops.export_scene.gltf(filepath=path),
        ".blend": lambda path: write_blend(path),
        ".off": lambda path: write_off(star(5, 3), tmp_path / "star.off"),
    }
    write[suffix](str(tmp_path / f"star{suffix}"))
    result = tmp_path / f"star_parts{suffix}"
    result.write_text("the old one")
    request.getfixturevalue("little_room")
    code, lines, errors = run("segment", tmp_path / f"star{suffix}")
    assert (code, lines, len(errors)) == (1, [], 1)
    assert result.read_text() == "the old one"
    assert sorted(path.name for path in tmp_path.iterdir() if "parts" in path.name) == [result.name]


def test_textures_are_found_from_the_result(run, tmp_path):
    add_object(star(3, 2))
    image = bpy.data.images.new("skin", 4, 4)
    image.filepath_raw, image.file_format = str(tmp_path / "skin.png"), "PNG"
    image.save()
    image.use_fake_user = True
    path = tmp_path / "star.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), relative_remap=True)
    bpy.ops.file.make_paths_relative()
    bpy.ops.wm.save_mainfile()
    run("segment", path)
    run("segment", path, "--output", tmp_path / "elsewhere" / "deep")
    for result in (tmp_path / "star_parts.blend", tmp_path / "elsewhere" / "deep" / "star_parts.blend"):
        bpy.ops.wm.open_mainfile(filepath=str(result))
        assert os.path.samefile(bpy.path.abspath(bpy.data.images["skin"].filepath), tmp_path / "skin.png")


def test_an_empty_folder_is_told(run, tmp_path):
    assert run("batch", tmp_path)[0] == 1
    assert "no such folder" in run("batch", tmp_path / "missing")[2][0]


def test_a_file_in_place_of_a_folder_is_told(run, star_off, tmp_path):
    assert run("batch", star_off)[2] == [f"{star_off}: it is a file; segment does single files."]
    assert run("segment", tmp_path)[2] == [f"{tmp_path}: it is a folder; batch does all files of folders."]


def test_a_file_of_the_user_that_is_called_like_a_result_is_a_source(run, folder):
    mine = write_off(star(6, 2), folder / "a_parts.off")
    before = mine.read_bytes()
    code, lines, errors = run("batch", folder)
    assert (code, len(lines)) == (1, 3)
    assert sum(line.startswith(f"{folder / 'a.off'}: its result would replace {mine}") for line in errors) == 1
    assert (mine.read_bytes(), (folder / "a_parts_parts.off").is_file()) == (before, True)
    code, _, errors = run("batch", folder, "--overwrite", "--jobs", 1)
    assert (code, mine.read_bytes()) == (1, before)
    assert (code, len(errors)) == (1, 3)


def test_a_result_that_was_changed_is_told_and_may_be_overwritten(run, folder):
    run("batch", folder)
    whole = (folder / "a_parts.off").read_bytes()
    os.truncate(folder / "a_parts.off", 0)
    code, lines, errors = run("batch", folder)
    assert (code, lines) == (1, [])
    assert f"{folder / 'a_parts.off'} is changed since it was written" in "".join(errors)
    assert run("batch", folder, "--overwrite", "--jobs", 1)[0] == 0
    assert (folder / "a_parts.off").read_bytes() == whole


@pytest.mark.parametrize("text", ['{"version": 1, "objects": [', "[1]", "5"])
def test_a_damaged_report_costs_no_more_than_doing_its_file_again(run, folder, text):
    run("batch", folder)
    before = results_in(folder)
    (folder / "a_parts.off.json").write_text(text)
    code, lines, told = run("batch", folder)
    assert (code, len(lines), results_in(folder)) == (0, 1, before)
    assert f"{folder / 'a.off'}: {folder / 'a_parts.off.json'} is no report, and stays as it is" in told


def test_one_folder_under_several_names_is_one(run, folder, tmp_path):
    (tmp_path / "link").symlink_to(folder)
    names = [folder, tmp_path / "link", folder / "deep", folder / "deep" / ".."]
    code, lines, _ = run("batch", *names, "--output", tmp_path / "out")
    assert (code, len(lines)) == (0, 3)
    assert sorted(results_in(tmp_path / "out")) == ["a_parts.off", "b_parts.off", "deep/down/c_parts.off"]
    assert run("batch", *reversed(names), "--output", tmp_path / "out")[2] == ["0 of 0 files (3 finished before)"]


@pytest.mark.parametrize("uri", [5, None, [1], "a\0b", "x" * 5000, ".", "../../../x"])
def test_a_gltf_with_nonsense_for_buffers_fails_alone(run, folder, uri):
    table = {"asset": {"version": "2.0"}, "buffers": [{"uri": uri, "byteLength": 4}]}
    (folder / "bad.gltf").write_text(json.dumps(table))
    for _ in range(2):
        code, _, errors = run("batch", folder)
        assert code == 1
        assert [line for line in errors if ".gltf: " in line] == [line for line in errors if " files" not in line]
    assert len(results_in(folder)) == 3


def test_a_full_disk_that_takes_no_words_is_told(run, star_off, monkeypatch):
    """What is told goes into a file there."""

    class Full(io.StringIO):
        def write(self, text):
            raise OSError(28, "No space left on device")

    monkeypatch.setattr("sys.stdout", Full())
    code, _, errors = run("segment", star_off, "--json-lines")
    assert (code, errors) == (1, ["No space left on device."])
