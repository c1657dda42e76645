"""Operators and command line do one thing: the same objects get the same labels, and the same warnings are told."""

import importlib

import bpy
import numpy as np
import pytest

from compute import TriangleMesh
from tests.blender.conftest import values_of
from tests.cli.files import add_object, turned, write_blend
from tests.compute.registration.shapes import lumpy_ball
from tests.shapes import icosphere, star, torus
from tools.extension import load_extension


@pytest.fixture
def window(capfd):
    """Open a file as the window does, call an operator on its objects, and return what it tells."""
    extension = load_extension()
    extension.register()

    def call(path, operator, active, **options):
        bpy.ops.wm.open_mainfile(filepath=str(path))
        bpy.context.view_layer.objects.active = bpy.data.objects[active]
        for obj in bpy.data.objects:
            obj.select_set(True)
        flush = importlib.import_module("eigenparts.cli.processes.suppress_output").flush_streams
        flush()
        capfd.readouterr()
        assert getattr(bpy.ops.eigenparts, operator)(**options) == {"FINISHED"}
        flush()
        lines = capfd.readouterr().out.splitlines()
        return {line.removeprefix("Warning: ") for line in lines if line.startswith("Warning: ")}

    yield call
    extension.unregister()


def beside_a_ball(mesh):
    """Return a mesh with a ball out of its reach, which analyses warn of."""
    ball = icosphere(1)
    vertices = np.vstack([mesh.vertices, 0.3 * ball.vertices + [9, 0, 0]])
    return TriangleMesh(vertices, np.vstack([mesh.triangles, ball.triangles + len(mesh.vertices)]))


def labels_of_objects():
    return {obj.name: values_of(obj.data, "part").tolist() for obj in bpy.data.objects}


def weights_of_objects():
    return {
        obj.name: [[(element.group, element.weight) for element in vertex.groups] for vertex in obj.data.vertices]
        for obj in bpy.data.objects
    }


def warnings_in(report):
    return {warning for file in report["files"] for row in file["objects"] for warning in row["warnings"]}


CHOICES = {
    "default": ([], {}),
    "eigenfunction": (["--field", "2"], {"field": "EIGENFUNCTION", "eigenfunction": 2}),
    "separate": (["--shells", "separate"], {"shells": "SEPARATE"}),
}


@pytest.mark.parametrize("choice", CHOICES)
def test_segment_is_the_same(run, window, tmp_path, choice):
    arguments, options = CHOICES[choice]
    add_object(beside_a_ball(star(5, 2)))
    path = write_blend(tmp_path / "star.blend")
    code, report, _ = run("segment", path, *arguments, "--json")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "star_parts.blend"))
    labels = labels_of_objects()
    assert code == 0
    assert "2 loose parts" in "".join(warnings_in(report))
    assert window(path, "analyze", "star", **options) == warnings_in(report)
    assert labels_of_objects() == labels


PAIRS = {
    "loose parts": (beside_a_ball(star(5, 2)), beside_a_ball(turned(star(5, 2))), "2 loose parts", False),
    # The command line writes what the window does, and fails as nobody may be there to look at it.
    "doubtful": (star(5, 2), torus(), "confidence of", True),
}


@pytest.mark.parametrize("pair", PAIRS)
def test_register_is_the_same(run, window, tmp_path, pair):
    reference, target, warning, fails = PAIRS[pair]
    add_object(target, "target")
    add_object(reference, "reference")
    path = write_blend(tmp_path / "two.blend")
    code, report, _ = run("register", path, "--reference", "reference", "--json")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "two_parts.blend"))
    labels = labels_of_objects()
    assert (code, warning in report["files"][0].get("error", "")) == (int(fails), fails)
    assert warning in "".join(warnings_in(report))
    assert window(path, "register_selected", "reference") == warnings_in(report)
    assert labels_of_objects() == labels


def test_register_takes_the_parts_that_were_divided_and_corrected_in_the_window(run, window, tmp_path):
    add_object(turned(star(5, 2)), "target")
    add_object(star(5, 2), "reference")
    window(write_blend(tmp_path / "plain.blend"), "analyze", "reference")
    bpy.ops.eigenparts.segment(level=3, mode="FEATURES")
    bpy.ops.eigenparts.split_part(part=1, position=0.4)
    path = write_blend(tmp_path / "two.blend")
    code, report, _ = run("register", path, "--reference", "reference", "--json")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "two_parts.blend"))
    labels = labels_of_objects()
    assert (code, report["files"][0]["objects"][0]["level"]) == (0, 3)
    assert window(path, "register_selected", "reference") == warnings_in(report)
    assert labels_of_objects() == labels


def test_transfer_is_the_same(run, window, tmp_path):
    add_object(beside_a_ball(turned(lumpy_ball(2))), "target")
    source = add_object(beside_a_ball(lumpy_ball(2)), "source")
    group = source.vertex_groups.new(name="High")
    for vertex in source.data.vertices:
        group.add([vertex.index], max(0.0, min(1.0, 0.5 + 0.4 * vertex.co.z)), "REPLACE")
    window(write_blend(tmp_path / "plain.blend"), "analyze", "target", order="1")
    bpy.context.view_layer.objects.active = bpy.data.objects["source"]
    bpy.ops.eigenparts.analyze(order="1")
    path = write_blend(tmp_path / "two.blend")
    code, report, _ = run("transfer", path, "--reference", "source", "--layers", "groups,parts", "--json")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "two_transferred.blend"))
    weights, labels = weights_of_objects(), labels_of_objects()
    told = window(path, "transfer", "source", layers={"GROUPS", "PARTS"})
    assert code == 0
    assert {warning.partition(" ")[0] for warning in told} == {"source:", "target:", "target"}
    assert told == warnings_in(report)
    assert (weights_of_objects(), labels_of_objects()) == (weights, labels)
