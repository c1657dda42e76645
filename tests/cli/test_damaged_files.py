"""Damaged files of every format: a result or a sentence for each, and the sentence says where and what to do."""

import re
import shutil

import bpy
import numpy as np
import pytest

from tests.cli.damage import damaged
from tests.cli.files import add_object, write_off
from tests.shapes import star

FORMATS = [
    "star.obj",
    "star.ply",
    "text.ply",
    "star.stl",
    "star.glb",
    "star.gltf",
    "star.fbx",
    "star.off",
    "star.blend",
]
RAW = re.compile(r"\b[A-Z]\w*(Error|Exception)\b|Traceback|\bError:|\.eigenparts-")
N_SEEDS = 4
N_SEEDS_LONG = 60


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A folder with a star in every format."""
    folder = tmp_path_factory.mktemp("sound")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_object(star(3, 1))
    bpy.ops.wm.obj_export(filepath=str(folder / "star.obj"))
    bpy.ops.wm.ply_export(filepath=str(folder / "star.ply"))
    bpy.ops.wm.ply_export(filepath=str(folder / "text.ply"), ascii_format=True)
    bpy.ops.wm.stl_export(filepath=str(folder / "star.stl"))
    bpy.ops.wm.stl_export(filepath=str(folder / "text.stl"), ascii_format=True)
    bpy.ops.export_scene.gltf(filepath=str(folder / "star.glb"))
    bpy.ops.export_scene.gltf(filepath=str(folder / "star.gltf"), export_format="GLTF_SEPARATE")
    bpy.ops.export_scene.fbx(filepath=str(folder / "star.fbx"))
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "star.blend"), copy=True, compress=False)
    write_off(star(3, 1), folder / "star.off")
    return folder


def outcome(run, path):
    """Divide a file and return the exit code and what is wrong with it."""
    code, report, _ = run("segment", path, "--json")
    (file,) = report["files"]
    assert code == int("error" in file)
    return file.get("error")


@pytest.mark.parametrize("name", FORMATS)
def test_a_damaged_file_gets_a_result_or_a_sentence(run, sound, tmp_path, name):
    assert_answered(run, sound, tmp_path, name, range(N_SEEDS))


@pytest.mark.long
@pytest.mark.parametrize("name", FORMATS)
def test_many_damaged_files_get_a_result_or_a_sentence(run, sound, tmp_path, name):
    assert_answered(run, sound, tmp_path, name, range(N_SEEDS, N_SEEDS_LONG))


def assert_answered(run, sound, tmp_path, name, seeds):
    for companion in ("star.bin", "star.mtl"):
        shutil.copy(sound / companion, tmp_path)
    for seed in seeds:
        content = damaged((sound / name).read_bytes(), np.random.default_rng([FORMATS.index(name), seed]))
        (tmp_path / name).write_bytes(content)
        problem = outcome(run, tmp_path / name)
        assert (tmp_path / name).read_bytes() == content
        assert problem is None or (problem.endswith(".") and not RAW.search(problem)), (seed, problem)
        assert not list(tmp_path.glob(".eigenparts-*"))


@pytest.mark.parametrize(
    ("name", "change", "said"),
    [
        ("star.glb", lambda data: data[:-100], "byte 8: the file should have"),
        ("star.glb", lambda data: data[:4] + b"\x07" + data[5:], "byte 4: it is of version 7"),
        ("star.glb", lambda data: data.replace(b'"bufferViews":[', b'"bufferViews";['), "chunk JSON, line 1, column"),
        ("star.gltf", lambda data: data.replace(b"star.bin", b"moon.bin"), 'buffers[0]: there is no file "moon.bin"'),
        ("star.gltf", lambda data: data.replace(b"{", b"[", 1), "line 2, column"),
        ("star.gltf", lambda data: re.sub(rb'"count":\d+', b'"count":99999', data), "accessors[0]: its 99999 entries"),
        ("star.gltf", lambda data: data.replace(b'"star.bin"', b'"a\\u0000b"'), "buffers[0]: it names no file"),
        ("star.gltf", lambda data: data.replace(b'"star.bin"', b'"data:;base64,A"'), "buffers[0]: its bytes are not"),
        ("star.fbx", lambda data: data[:-2000], "and the file has"),
        ("star.fbx", lambda data: b"; FBX 7.3.0 project file", "an .fbx written as text"),
        ("star.blend", lambda data: data[: len(data) // 2], "within a block of"),
        ("star.blend", lambda data: b"no " + data, "byte 0: this is no .blend file"),
        (
            "star.blend",
            lambda data: re.sub(rb"v(0?)\d", rb"v\g<1>9", data[:2000], count=1),
            "it was saved by Blender 9.",
        ),
        ("star.stl", lambda data: data[:-60], "after 78 of 80 triangles"),
        ("star.stl", lambda data: data + b"by hand", "byte 4084: there is something behind the 80 triangles"),
        ("star.stl", lambda data: b"solid facet".ljust(80) + data[80:-60], "after 78 of 80 triangles"),
        ("text.stl", lambda data: data[: data.rindex(b"endsolid")], "line 561: the file is cut short"),
        ("text.stl", lambda data: data[: data.rindex(b"endfacet")], "line 560: the file is cut short"),
        ("text.stl", lambda data: data[: data.index(b"vertex")], "line 3: the file is cut short"),
        ("text.stl", lambda data: data.replace(b"endfacet\n", b"", 1), "line 8: a facet has its first line, three"),
        ("text.stl", lambda data: data.upper(), "line 4: Blender cannot read VERTEX in capitals; export it"),
        (
            "text.stl",
            lambda data: data.replace(b"\n", b"\r"),
            "Blender can only read a text whose vertices have a line",
        ),
        ("star.ply", lambda data: data[:-7], 'a row of "face" with 3 entries does not fit'),
        ("star.ply", lambda data: data.replace(b"end_header", b"end_haeder"), 'the header has no line "end_header"'),
        ("star.ply", lambda data: data.replace(b"float y", b"flaot y"), 'line 6: "property flaot y"'),
        ("star.ply", lambda data: data[:-4] + b"\xff\xff\x00\x00", "none of the 42 vertices"),
        ("text.ply", lambda data: data.replace(b"face 80", b"face 81"), "after 80 of 81 rows"),
        ("text.ply", lambda data: data.replace(b"\n3 ", b"\n4 ", 1), "the row has fewer numbers than it should"),
        (
            "text.ply",
            lambda data: data.replace(b"vertex 42", b"vertex 41"),
            "line 52: there are 3 numbers where 1 belong",
        ),
    ],
)
def test_the_sentence_says_where(run, sound, tmp_path, name, change, said):
    shutil.copy(sound / "star.bin", tmp_path)
    (tmp_path / name).write_bytes(change((sound / name).read_bytes()))
    problem = outcome(run, tmp_path / name)
    assert said in problem
    assert not RAW.search(problem)
    assert problem.endswith(".")


@pytest.mark.parametrize("name", FORMATS)
def test_a_sound_file_is_not_refused(run, sound, tmp_path, name):
    for path in sound.iterdir():
        shutil.copy(path, tmp_path)
    assert outcome(run, tmp_path / name) is None


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("star.stl", lambda data: b"solid star".ljust(80) + data[80:]),
        ("text.stl", lambda data: data.replace(b"solid", b"SOLID").replace(b"facet", b"Facet")),
        ("text.stl", lambda data: b"\xef\xbb\xbf" + data.replace(b"\n", b"\r\n") + b"\r\n; by hand\r\n"),
    ],
)
def test_an_stl_is_text_or_binary_by_what_is_in_it(run, sound, tmp_path, name, change):
    (tmp_path / name).write_bytes(change((sound / name).read_bytes()))
    _, report, _ = run("segment", tmp_path / name, "--json")
    assert (len(bpy.data.meshes[0].polygons), report["files"][0]["objects"][0]["warnings"]) == (80, [])
