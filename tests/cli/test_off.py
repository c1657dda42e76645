"""The Object File Format as it is found in the wild."""

import struct

import bpy
import numpy as np
import pytest

from tests.cli.files import write_off
from tests.shapes import star
from tools.extension import load_extension

TRIANGLE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


@pytest.fixture(scope="module")
def parse_off():
    load_extension()
    from eigenparts.cli.formats.off import parse_off

    return parse_off


@pytest.fixture(scope="module")
def refusal():
    load_extension()
    from eigenparts.tasks.refusals import Refusal

    return Refusal


def faces_of(file):
    return [row.tolist() for row in np.split(file.corners, np.cumsum(file.n_corners))[:-1]]


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "# made by hand\nOFF\n\n3 1 3 # counts\n0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2 255 0 0\n",
        "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2",
        "OFF\n3\n1\n0\n0\n0\n0\n1\n0\n0\n0\n1\n0\n3\n0\n1\n2\n",
        "OFF\n3 1 0\n0 0 0 1 0 0 0 1 0\n3 0 1 2 0.5 0.5 0.5 1\n",
        "OFF\n3 1 0\n0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2 7\n",
        "COFF\n3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n",
        "COFF 3 1 0 0 0 0 1 1 1 1 1 0 0 1 1 1 1 0 1 0 1 1 1 1 3 0 1 2",
        "COFF 3 1 0 0 0 0 9 9 9 1 0 0 9 9 9 0 1 0 9 9 9 3 0 1 2",
        "COFF 3 1 0 0 0 0 .9 .9 .9 1 0 0 .9 .9 .9 0 1 0 .9 .9 .9 3 0 1 2",
        "NOFF 3 1 0 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 3 0 1 2",
        "STCNOFF 3 1 0 0 0 0 0 0 1 1 1 1 1 5 5 1 0 0 0 0 1 1 1 1 1 5 5 0 1 0 0 0 1 1 1 1 1 5 5 3 0 1 2",
        "4OFF\n3 1 0\n0 0 0 2\n2 0 0 2\n0 3 0 3\n3 0 1 2\n",
        "nOFF 3\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n",
        "OFF\r3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r",
        "\ufeffOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    ],
)
def test_all_ways_to_write_a_triangle(parse_off, text):
    file = parse_off(text.encode())
    assert (file.vertices.tolist(), faces_of(file)) == (TRIANGLE, [[0, 1, 2]])


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "cp1252", "utf-16"])
def test_comments_may_have_any_encoding(parse_off, encoding):
    text = "OFF\n# Körper ist schön\n3 1 0 # äöü\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    assert parse_off(text.encode(encoding)).vertices.tolist() == TRIANGLE


def test_an_ellipsis_of_windows_is_no_end_of_a_line(parse_off):
    assert parse_off(b"OFF\n# and so on\x85 17\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").vertices.tolist() == TRIANGLE


@pytest.mark.parametrize("keyword", ["OFF", "COFF", "4OFF"])
def test_binary_files_are_read(parse_off, keyword):
    weight = [1.0] if keyword == "4OFF" else []
    colour = [0.5] * 4 if keyword == "COFF" else []
    points = [number for point in TRIANGLE for number in [*point, *weight, *colour]]
    data = struct.pack(f">3i{len(points)}f4iif", 3, 1, 0, *points, 3, 0, 1, 2, 1, 0.5)
    file = parse_off(f"{keyword} BINARY\n".encode() + data)
    assert (file.vertices.tolist(), faces_of(file)) == (TRIANGLE, [[0, 1, 2]])


def test_faces_of_all_sizes_keep_their_order(parse_off):
    faces = [[0, 1, 2, 3], [0, 1], [2, 1, 0], [], [4, 3, 2, 1, 0], [0, 1, 9]]
    rows = "\n".join(" ".join(map(str, [len(face), *face])) + " 0.5 0.5 0.5" for face in faces)
    points = "\n".join(f"{k} 0 0" for k in range(5))
    assert faces_of(parse_off(f"OFF\n5 6 0\n{points}\n{rows}\n".encode())) == faces


@pytest.mark.parametrize("word", ["nan", "-nan", "inf", "-1.#IND", "1.#QNAN", "-nan(ind)"])
def test_numbers_that_are_none_are_read_as_such(parse_off, word):
    vertices = parse_off(f"OFF\n3 1 0\n0 0 0\n1 {word} 0\n0 1 0\n3 0 1 2\n".encode()).vertices
    assert np.isfinite(vertices).all(axis=1).tolist() == [True, False, True]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "line 1: an .off file begins with"),
        ("PLY\n", "line 1: an .off file begins with"),
        ("OFF\n", "line 1: an .off file begins with"),
        ("OFF\n3 1 0\n0 0 0\n", "ends before the 3 points and 1 faces"),
        ("OFF\n# two\n1 0 0\n\n0 zero 0\n", "line 5: 'zero' is no number"),
        ("OFF\n2 0 0\n0 0 0\n0 0\n", "line 4: '0 0' is no point"),
        ("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1\n", "line 7: '3 0 1' is no face"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1.5 2\n", "line 6: '3 0 1.5 2' is no face"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "line 6: '-3 0 1 2' is no face"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n9999999999999 0 1 2\n", "line 6: '9999999999999 0 1 2' is no face"),
        ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n", "line 6: '3 0 1 nan' is no face"),
        ("nOFF\n5\n3 1 0\n", "its points have 5 coordinates"),
        ("OFF\n999999999999 1 0\n0 0 0\n", "ends before"),
        ("OFF BINARY\n\0\0\0\3", "the binary file ends before"),
        ("OFF BINARY\n\0\0\0\0\x7f\x7f\x7f\x7f\0\0\0\0" + 9 * "\x7f", "the binary file ends before"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(parse_off, refusal, text, sentence):
    with pytest.raises(refusal, match=sentence):
        parse_off(text.encode())


def rows_of_faces(path):
    lines = path.read_text().splitlines()
    return lines[2 + int(lines[1].split()[0]) :]


def test_each_face_keeps_its_line(run, tmp_path):
    """Faces that are none are told; their lines have the colour of what is around their first point."""
    mesh = star(5, 3)
    lines = write_off(mesh, tmp_path / "star.off").read_text().splitlines()
    n_vertices = len(mesh.vertices)
    tip = int(mesh.vertices[:, 0].argmax())
    odd = [f"2 {tip} 0", f"3 {tip} {tip} 0", f"3 {tip} 0 {n_vertices}", lines[-1], "0"]
    rows = lines[2 + n_vertices :]
    rows[100:100] = odd
    text = ["OFF", f"{n_vertices} {len(rows)} 0", *lines[2 : 2 + n_vertices], *rows]
    (tmp_path / "odd.off").write_text("\n".join(text))
    run("segment", tmp_path / "star.off")
    _, report, _ = run("segment", tmp_path / "odd.off", "--json")
    assert any("cannot be divided: 5 of 1285" in told for told in report["files"][0]["objects"][0]["warnings"])
    expected, found = rows_of_faces(tmp_path / "star_parts.off"), rows_of_faces(tmp_path / "odd_parts.off")
    assert found[:100] + found[105:] == expected
    assert [row.split()[: int(row.split()[0]) + 1] for row in found[100:105]] == [row.split() for row in odd]
    colour_of_tip = next(row.split()[4:] for row in expected if str(tip) in row.split()[1:4])
    assert [row.split()[-3:] for row in found[100:103]] == [colour_of_tip] * 3
    assert found[103] == expected[-1]


@pytest.mark.parametrize(
    ("behind", "told"),
    [
        ("3 0 1 2\n\n# more\n3 0 1 2\n", "2 lines behind the last face, from line 1925 on, were not read: the head"),
        ("by hand\n", "1 line behind the last face, line 1925, was not read: the head counts fewer faces."),
    ],
)
def test_lines_behind_the_last_face_are_told(run, tmp_path, behind, told):
    path = write_off(star(5, 3), tmp_path / "star.off")
    path.write_text(path.read_text() + behind)
    _, report, _ = run("segment", path, "--json")
    (warning,) = report["files"][0]["objects"][0]["warnings"]
    assert warning.startswith(told)


def test_a_result_can_be_divided_again_line_by_line(run, star_off, tmp_path):
    run("segment", star_off, "--output", tmp_path)
    again = (tmp_path / "star_parts.off").rename(tmp_path / "again.off")
    assert run("segment", again)[0] == 0
    assert rows_of_faces(tmp_path / "again_parts.off") == rows_of_faces(again)


def test_a_mesh_of_another_file_is_written_with_its_own_faces(run, tmp_path):
    run("--help")
    from eigenparts.cli import formats

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    mesh, faces = bpy.data.meshes.new("house"), [[0, 1, 2, 3], [3, 2, 4]]
    mesh.from_pydata([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 1.5, 0]], [], faces)
    file = formats.OpenFile([bpy.data.objects.new("house", mesh)], {})
    formats.save(tmp_path / "house.off", file)
    rows = [list(map(int, row.split())) for row in rows_of_faces(tmp_path / "house.off")]
    assert [row[: row[0] + 1] for row in rows] == [[len(corners), *corners] for corners in faces]


def test_a_point_that_is_no_number_goes_between_its_neighbours(run, tmp_path):
    mesh = star(5, 3)
    around = np.unique(mesh.triangles[(mesh.triangles == 10).any(axis=1)])
    middle = mesh.vertices[around[around != 10]].mean(axis=0)
    mesh.vertices[10] = np.nan
    _, report, _ = run("segment", write_off(mesh, tmp_path / "s.off"), "--json")
    (row,) = report["files"][0]["objects"]
    assert len(row["parts"]) == 6
    assert any("no numbers in the file: 1;" in told for told in row["warnings"])
    np.testing.assert_allclose(
        np.array((tmp_path / "s_parts.off").read_text().splitlines()[12].split(), float), middle, atol=1e-5
    )
    assert bpy.data.objects["s"].type == "MESH"
