"""The command ``register``: equal numbers are the same part, in every file."""

import bpy
import numpy as np
import pytest

from tests.cli.files import add_object, turned, write_blend, write_off
from tests.shapes import icosphere, star, torus


def areas_of_parts(row):
    return {part["id"]: part["area"] for part in row["parts"]}


@pytest.fixture(scope="module")
def unequal():
    """Five arms of different lengths on a ball, so that each is told from the others by its area."""
    return star(5, 2)


def test_a_turned_and_shuffled_copy_gets_the_numbers_of_the_reference(run, tmp_path):
    mesh = star(5, 3)
    files = [write_off(mesh, tmp_path / "first.off"), write_off(turned(mesh), tmp_path / "copy.off")]
    code, report, errors = run("register", *files, "--borders", "exact", "--json")
    reference, copy = (areas_of_parts(file["objects"][0]) for file in report["files"])
    assert (code, errors, len(reference)) == (0, [], 6)
    # No two arms have the same area.
    assert min(np.diff(sorted(reference.values()))) > 0.06 * 7
    assert copy == pytest.approx(reference, rel=0.03)
    assert [file["objects"][0].get("reference") for file in report["files"]] == [None, "first"]


def test_objects_of_one_file_are_registered_among_themselves(run, unequal, tmp_path):
    for name, angle in [("a", 0), ("b", 1), ("c", 2)]:
        add_object(turned(unequal, angle), name)
    path = write_blend(tmp_path / "three.blend")
    code, report, _ = run("register", path, "--reference", "b", "--json")
    rows = {row["name"]: row for row in report["files"][0]["objects"]}
    assert code == 0
    assert [name for name, row in rows.items() if row.get("reference") == "b"] == ["a", "c"]
    assert areas_of_parts(rows["a"]) == pytest.approx(areas_of_parts(rows["b"]), rel=0.03)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "three_parts.blend"))
    assert bpy.data.objects["a"].data["eigenparts_state"]["registration"]["reference"] == "b"


def test_the_reference_may_be_a_file_that_is_not_written(run, unequal, tmp_path):
    source, other = write_off(unequal, tmp_path / "source.off"), write_off(turned(unequal), tmp_path / "other.off")
    run("register", other, "--source", source, "--parts", 4)
    assert sorted(path.name for path in tmp_path.glob("*_parts.off")) == ["other_parts.off"]


def test_level_names_and_colours_of_the_reference_travel(run, unequal, tmp_path):
    add_object(unequal)
    run("segment", write_blend(tmp_path / "named.blend"), "--parts", 4)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "named_parts.blend"))
    state = bpy.data.objects["star"].data["eigenparts_state"]
    longest = int(state["parts"]["id"]["values"][1])
    state["part_names"], state["part_colours"] = {str(longest): "longest arm"}, {str(longest): [1.0, 0.0, 0.0]}
    bpy.ops.wm.save_mainfile()
    other = write_off(turned(unequal), tmp_path / "other.off")
    _, report, _ = run("register", other, "--source", tmp_path / "named_parts.blend", "--json")
    parts = {part["name"]: part for part in report["files"][0]["objects"][0]["parts"]}
    assert len(parts) == 4
    lines = (tmp_path / "other_parts.off").read_text().splitlines()
    assert sum(line.endswith(" 255 0 0") for line in lines) == parts["longest arm"]["faces"] > 0


def test_parts_without_a_partner_have_numbers_of_their_own(run, unequal, tmp_path):
    """A ball has no parts to offer, so all arms of all others are their own."""
    files = [write_off(turned(unequal, seed=seed), tmp_path / f"star{seed}.off") for seed in (1, 2)]
    ball = write_off(icosphere(2), tmp_path / "ball.off")
    _, report, _ = run("register", *files, "--source", ball, "--json")
    rows = [file["objects"][0]["parts"] for file in report["files"]]
    own = [part["id"] for parts in rows for part in parts if not part["matched"]]
    assert len(own) == len(set(own))
    assert all(part["matched"] == (part["id"] == 0) for parts in rows for part in parts)


def test_a_bad_reference_is_told_for_every_file(run, star_off, tmp_path):
    code, lines, errors = run("register", star_off, "--source", tmp_path / "missing.off", "--output", tmp_path)
    assert (code, lines, len(errors)) == (1, [], 1)
    assert "the reference" in errors[0]
    assert "no such file" in errors[0]


def test_a_bad_file_does_not_stop_the_others(run, unequal, tmp_path):
    source, broken = write_off(unequal, tmp_path / "a.off"), tmp_path / "b.off"
    broken.write_text("OFF\n3 1 0\n")
    code, lines, errors = run("register", source, broken, write_off(turned(unequal), tmp_path / "c.off"))
    assert (code, len(lines), len(errors)) == (1, 2, 1)
    assert errors[0].startswith(f"{broken}: ")


def test_a_matching_that_is_hardly_ever_right_fails_but_is_written_as_in_the_window(run, unequal, tmp_path):
    ring = write_off(torus(), tmp_path / "ring.off")
    source = write_off(unequal, tmp_path / "star.off")
    code, report, errors = run("register", ring, "--source", source, "--json")
    (file,) = report["files"]
    assert (code, len(errors)) == (1, 1)
    assert file["objects"][0]["confidence"] < 0.05
    assert file["error"].startswith(
        "ring: it is matched with a confidence of 0% only, so its parts are very likely wrong"
    )
    assert (tmp_path / "ring_parts.off").is_file()
